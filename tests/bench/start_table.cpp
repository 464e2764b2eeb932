// SPDX-License-Identifier: BSD-3-Clause
// How often a reconstruction starts rightly, by factorisation, by two views, and by what is chosen
// of both; and what the search over a whole sequence finds. Prints Markdown tables.
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string>

#include <fmt/format.h>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/scene_start.hpp"
#include "daemon/reconstruction/start_candidate.hpp"
#include "daemon/reconstruction/start_choice.hpp"
#include "daemon/reconstruction/start_factorisation.hpp"
#include "daemon/reconstruction/start_search.hpp"
#include "daemon/reconstruction/start_two_views.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace handeye::test {
namespace {

struct Case {
  std::string name;
  Motion motion;
  SyntheticOptions tracks;
  double focal_factor{1.0};  ///< given focal length over the true one
};

enum class Verdict { kRight, kWrong, kRefused };

struct Tally {
  int right{0}, wrong{0}, refused{0};

  void add(Verdict verdict) {
    ++(verdict == Verdict::kRight ? right : verdict == Verdict::kWrong ? wrong : refused);
  }
  std::string text() const { return fmt::format("{} / {} / {}", right, wrong, refused); }
};

std::vector<FrameRecord> records_of(const SyntheticTracks& tracks) {
  std::vector<FrameRecord> records;
  for (const TrackedFrame& frame : tracks.frames) records.push_back(make_record(frame));
  return records;
}

/// Right: rotations within 1 deg rms, camera centres within a quarter of their extent; with a wrong
/// focal length within 4 deg and half.
Verdict judge(const Scene& scene, const SyntheticTracks& truth, double focal_factor) {
  std::vector<RegisteredFrame> frames;
  for (const Keyframe& keyframe : scene.keyframes) {
    RegisteredFrame frame;
    frame.index = keyframe.frame_index;
    frame.eye_from_scene = keyframe.eye_from_scene;
    frames.push_back(frame);
  }
  const AlignmentError error = compare(frames, truth.eye_from_room);
  const bool given = focal_factor == 1.0;
  const bool right = error.rotation_rms_deg < (given ? 1.0 : 4.0) &&
                     error.centre_rms < (given ? 0.25 : 0.5) * error.extent;
  return right ? Verdict::kRight : Verdict::kWrong;
}

Verdict best_of(const CameraModel& camera, const ReconstructionOptions& options,
                const StartWindow& window, const std::vector<StartHypothesis>& hypotheses,
                const SyntheticTracks& truth, double focal_factor) {
  std::vector<StartCandidate> candidates;
  for (const StartHypothesis& hypothesis : hypotheses) {
    candidates.push_back(make_candidate(camera, options, window, hypothesis, 80));
    adjust_candidate(camera, options, candidates.back());
  }
  const auto chosen = choose_start(candidates);
  if (!chosen || candidates[*chosen].inlier_ratio < 0.5 ||
      candidates[*chosen].parallax_rad < options.min_start_parallax_px / kReferenceFocalPx) {
    return Verdict::kRefused;
  }
  return judge(candidates[*chosen].scene, truth, focal_factor);
}

void run(const Case& test_case, int seeds) {
  constexpr std::size_t kWindow = 25;
  Tally factorisation;
  Tally two_views;
  Tally chosen;
  Tally search;
  int by_factorisation = 0;
  double start_ms = 0.0;
  double refused_ms = 0.0;
  int started_after = 0;
  int attempts = 0;
  double slowest_ms = 0.0;
  const ReconstructionOptions options;
  for (int seed = 1; seed <= seeds; ++seed) {
    SyntheticOptions synthetic = test_case.tracks;
    synthetic.seed = static_cast<unsigned>(seed);
    synthetic.frames = 150;
    const double shift_s = 0.37 * seed;
    const SyntheticTracks truth =
        synthesize(synthetic, [&](double time_s) { return test_case.motion(time_s + shift_s); });
    CameraModel camera = truth.camera;
    camera.fx *= test_case.focal_factor;
    camera.fy *= test_case.focal_factor;
    if (test_case.focal_factor != 1.0) camera.distortion = {};
    const auto records = records_of(truth);
    const std::span<const FrameRecord> stretch(records.data(), kWindow);

    const StartWindow window = make_start_window(camera, stretch, 8);
    const double noise = 0.5 * options.max_reprojection_px / focal_px(camera);
    factorisation.add(best_of(camera, options, window, start_by_factorisation(window, noise), truth,
                              test_case.focal_factor));
    const Eigen::Index last = window.frame_count() - 1;
    auto motions = two_view_motions(window.pairs_with_first(last), noise);
    std::erase_if(motions, [](const auto& motion) { return motion.inlier_ratio < 0.4; });
    two_views.add(best_of(camera, options, window,
                          start_by_two_views(camera, options, window, last, motions), truth,
                          test_case.focal_factor));

    const StartAttempt attempt = start_scene(camera, options, stretch);
    chosen.add(attempt.scene ? judge(*attempt.scene, truth, test_case.focal_factor)
                             : Verdict::kRefused);
    if (attempt.scene && attempt.method == StartMethod::kFactorisation) ++by_factorisation;

    StartSearch finder(camera, options);
    std::vector<FrameRecord> seen;
    Verdict verdict = Verdict::kRefused;
    for (const FrameRecord& record : records) {
      seen.push_back(record);
      const std::clock_t begin = std::clock();
      const StartAttempt found = finder.look(seen);
      const double ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      slowest_ms = std::max(slowest_ms, ms);
      if (found.scene) {
        start_ms += ms;
        verdict = judge(*found.scene, truth, test_case.focal_factor);
        started_after += static_cast<int>(seen.size());
        break;
      }
      if (found.costly) {
        refused_ms += ms;
        ++attempts;
      }
    }
    search.add(verdict);
  }
  const int started = std::max(1, search.right + search.wrong);
  fmt::print("| {} | {} | {} | {} | {} | {} | {:.0f} | {:.1f} | {:.1f} | {:.0f} |\n",
             test_case.name, factorisation.text(), two_views.text(), chosen.text(),
             by_factorisation, search.text(), static_cast<double>(started_after) / started,
             start_ms / started, refused_ms / std::max(1, attempts), slowest_ms);
  std::fflush(stdout);
}

int run_all(int seeds, const std::string& only) {
  fmt::print(
      "| scene | factorisation | two views | both | won by factorisation | search | frames | "
      "start ms | refused ms | slowest ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, Motion motion, SyntheticOptions tracks = {},
                       double focal_factor = 1.0) {
    cases.push_back({name, std::move(motion), tracks, focal_factor});
  };
  for (const double relief_mm : {16.0, 8.0, 4.0, 1.5, 0.0}) {
    SyntheticOptions tracks;
    tracks.relief_mm = relief_mm;
    add(fmt::format("free hand, relief {} mm", relief_mm), free_hand(), tracks);
    add(fmt::format("sideways, relief {} mm", relief_mm), sideways(), tracks);
    add(fmt::format("orbit, relief {} mm", relief_mm), orbit(), tracks);
    add(fmt::format("forward, relief {} mm", relief_mm), forward(), tracks);
  }
  SyntheticOptions noisy;
  noisy.noise_px = 1.0;
  add("free hand, noise 1 px", free_hand(), noisy);
  add("orbit, noise 1 px", orbit(), noisy);
  SyntheticOptions wrong;
  wrong.outlier_tracks = 0.3;
  add("free hand, 30 % sliding", free_hand(), wrong);
  for (const double share : {0.2, 0.33}) {
    SyntheticOptions instrument;
    instrument.instrument_share = share;
    add(fmt::format("free hand, instrument {}", share), free_hand(), instrument);
    add(fmt::format("orbit, instrument {}", share), orbit(), instrument);
    add(fmt::format("turning, instrument {}", share), turning_only(), instrument);
    add(
        fmt::format("still, instrument {}", share), [](double) { return free_hand()(0.0); },
        instrument);
  }
  add("turning only", turning_only());
  for (const double share : {0.02, 0.05, 0.1, 0.2}) {
    add(fmt::format("turning, shifts of {} mm", 15.0 * share), nearly_turning(share));
  }
  for (const double factor : {0.6, 0.8, 1.25, 1.4}) {
    add(fmt::format("free hand, focal length x {}", factor), free_hand(), {}, factor);
    add(fmt::format("orbit, focal length x {}", factor), orbit(), {}, factor);
  }
  for (const Case& test_case : cases) {
    if (test_case.name.find(only) != std::string::npos) run(test_case, seeds);
  }
  return 0;
}

}  // namespace
}  // namespace handeye::test

int main(int argc, char** argv) {
  return handeye::test::run_all(argc > 1 ? std::atoi(argv[1]) : 100, argc > 2 ? argv[2] : "");
}
