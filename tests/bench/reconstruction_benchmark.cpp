// SPDX-License-Identifier: BSD-3-Clause
// What the reconstruction costs a frame and at the end: 30 s at 25 Hz of synthetic tracks.
#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "daemon/geometry/median.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace {

double elapsed_ms(const std::function<void()>& work) {
  const auto before = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before)
      .count();
}

}  // namespace

int main() {
  using namespace handeye;
  test::SyntheticOptions options;
  options.frames = 750;
  options.max_features = 300;
  const test::SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  IncrementalReconstruction reconstruction(tracks.camera);
  std::vector<double> add_ms;
  double sum_ms = 0.0;
  double most_ms = 0.0;
  for (const TrackedFrame& frame : tracks.frames) {
    add_ms.push_back(elapsed_ms([&] { reconstruction.add(frame); }));
    sum_ms += add_ms.back();
    most_ms = std::max(most_ms, add_ms.back());
  }
  Reconstruction result;
  const double current_ms = elapsed_ms([&] { result = reconstruction.current(); });
  const double finish_ms = elapsed_ms([&] { result = reconstruction.finish(); });
  const auto error = test::compare(result.frames, tracks.eye_from_room);
  fmt::print("{} frames, {} keyframes, {} points\n", result.frames.size(),
             reconstruction.keyframes(), result.points);
  fmt::print("add      mean {:.2f} ms, median {:.2f} ms, most {:.1f} ms\n",
             sum_ms / static_cast<double>(add_ms.size()), median(add_ms), most_ms);
  fmt::print("current  {:.2f} ms\nfinish   {:.0f} ms\n", current_ms, finish_ms);
  fmt::print("error    {:.3f} deg, {:.2f} % of 80 mm (rms after alignment)\n",
             error.rotation_rms_deg, 100.0 * error.centre_rms / 80.0);
  return 0;
}
