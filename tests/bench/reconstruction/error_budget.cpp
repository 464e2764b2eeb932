// SPDX-License-Identifier: BSD-3-Clause
// Where accuracy is lost: for each rendered sequence how far the tracked features are from where
// the scene points of their first appearance truly are, and what the camera poses lose to that.
// Beside the poses from the features as tracked stand those from the same tracks with true
// positions, to which independent noise of the same size is added: what would be left were the
// errors only noise. Usage: reconstruction_error_budget [NAME...]   (default: the eight that must
// be mastered)
#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/image_stage.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/sequences/pose_error.hpp"
#include "tests/sequences/sequence.hpp"

namespace {

using namespace handeye;
using namespace handeye::sequences;

constexpr std::uint32_t kNoiseSeed = 1;
/// A feature farther off follows something else: it is no measure of the noise.
constexpr double kGrossPx = 1.0;

/// What was tracked through a sequence, and the truth about it.
struct Tracks {
  CameraModel camera;
  double scene_distance_mm{0};
  std::vector<TrackedFrame> tracked;
  std::vector<TrackedFrame> exact;  ///< the same features where they truly are
  std::vector<double> errors_px;    ///< of all but first appearances
  std::size_t features{0};          ///< in all frames together
  std::size_t tracks{0};
  std::map<std::int64_t, Pose> scene_from_eye;  ///< by time stamp
};

/// Scene points of features, fixed where they appear first.
class FirstAppearances {
 public:
  explicit FirstAppearances(const CameraModel& camera) : camera_(camera) {}

  /// Where a feature truly is in this frame; nothing where the scene behind it is not known.
  std::optional<Eigen::Vector2d> true_position(const Observation& seen,
                                               const SequenceFrame& frame) {
    const auto [entry, is_new] = points_.try_emplace(seen.feature_id);
    if (is_new) entry->second = point_behind(seen.pixel, frame);
    if (!entry->second) return std::nullopt;
    const Eigen::Vector3d point_eye = frame.scene_from_eye.inverse() * *entry->second;
    return project<double>(camera_, point_eye);
  }

  std::size_t count() const { return points_.size(); }

 private:
  std::optional<Eigen::Vector3d> point_behind(const Eigen::Vector2d& pixel,
                                              const SequenceFrame& frame) const {
    const int x = static_cast<int>(std::floor(pixel.x()));
    const int y = static_cast<int>(std::floor(pixel.y()));
    const cv::Mat1f& depth = frame.depth_mm;
    if (x < 0 || y < 0 || x + 1 >= depth.cols || y + 1 >= depth.rows) return std::nullopt;
    const double ax = pixel.x() - x;
    const double ay = pixel.y() - y;
    const double depth_mm = (1 - ay) * ((1 - ax) * depth(y, x) + ax * depth(y, x + 1)) +
                            ay * ((1 - ax) * depth(y + 1, x) + ax * depth(y + 1, x + 1));
    const auto ray = unproject(camera_, pixel);
    if (!ray || depth(y, x) <= 0 || depth(y + 1, x + 1) <= 0) return std::nullopt;
    return frame.scene_from_eye * (depth_mm * ray->homogeneous());
  }

  const CameraModel& camera_;
  std::map<std::int64_t, std::optional<Eigen::Vector3d>> points_;
};

Tracks track(const std::string& name) {
  Sequence sequence(name);
  Tracks tracks;
  tracks.camera = sequence.camera();
  tracks.scene_distance_mm = sequence.scene_distance_mm();
  const auto images = make_image_stage(std::nullopt, cv::Mat(), sequence.camera());
  FirstAppearances first(sequence.camera());
  SequenceFrame drawn;
  Frame frame;
  TrackedFrame tracked;
  while (sequence.next(drawn)) {
    frame.grey = drawn.grey;
    frame.timestamp_ns = drawn.timestamp_ns;
    images->process(frame, tracked);
    TrackedFrame exact = tracked;
    exact.observations.clear();
    for (const Observation& seen : tracked.observations) {
      const std::size_t before = first.count();
      const auto pixel = first.true_position(seen, drawn);
      if (!pixel) continue;
      exact.observations.push_back({seen.feature_id, *pixel});
      if (first.count() == before) tracks.errors_px.push_back((seen.pixel - *pixel).norm());
    }
    tracks.features += tracked.observations.size();
    tracks.tracks = first.count();
    tracks.tracked.push_back(tracked);
    tracks.exact.push_back(std::move(exact));
    tracks.scene_from_eye[drawn.timestamp_ns] = drawn.scene_from_eye;
  }
  return tracks;
}

/// Per axis, of the features that follow their point.
double noise_px(const Tracks& tracks) {
  double sum = 0;
  int count = 0;
  for (const double error : tracks.errors_px) {
    if (error > kGrossPx) continue;
    sum += error * error;
    count += 2;
  }
  return std::sqrt(sum / std::max(1, count));
}

void add_noise(double sigma_px, std::vector<TrackedFrame>& frames) {
  std::mt19937 random(kNoiseSeed);
  std::normal_distribution<double> noise(0, sigma_px);
  for (TrackedFrame& frame : frames) {
    for (Observation& seen : frame.observations) {
      seen.pixel.x() += noise(random);
      seen.pixel.y() += noise(random);
    }
  }
}

/// Rotation [deg], position [% of the scene's distance] and turning [deg] as words.
std::string pose_errors(const Tracks& tracks, const std::vector<TrackedFrame>& frames) {
  IncrementalReconstruction reconstruction(tracks.camera);
  for (const TrackedFrame& frame : frames) reconstruction.add(frame);
  std::vector<PosePair> pairs;
  for (const RegisteredFrame& frame : reconstruction.finish().frames) {
    if (frame.part != 0) continue;
    pairs.push_back({tracks.scene_from_eye.at(frame.timestamp_ns), frame.eye_from_scene.inverse()});
  }
  const auto error = pose_error(pairs, tracks.scene_distance_mm);
  if (!error) return fmt::format("{:>10} {:>10} {:>10}", "-", "-", "-");
  return fmt::format("{:10.4f} {:10.4f} {:10.4f}", error->rotation_rms_deg,
                     100 * error->position_rms, error->turning_rms_deg);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

void print_row(const std::string& name) {
  const Tracks tracks = track(name);
  const double sigma_px = noise_px(tracks);
  std::vector<TrackedFrame> noisy = tracks.exact;
  add_noise(sigma_px, noisy);
  fmt::print("{:<14} {:8.0f} {:8.1f} {:8.3f} {:8.3f} {:8.3f} | {} | {}\n", name,
             static_cast<double>(tracks.features) / static_cast<double>(tracks.tracked.size()),
             static_cast<double>(tracks.features) / static_cast<double>(tracks.tracks),
             quantile(tracks.errors_px, 0.5), quantile(tracks.errors_px, 0.9), sigma_px,
             pose_errors(tracks, tracks.tracked), pose_errors(tracks, noisy));
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names.assign(must_have_names().begin(), must_have_names().end());
  fmt::print("{:<14} {:>8} {:>8} {:>8} {:>8} {:>8} | {:>32} | {:>32}\n", "", "features", "frames",
             "error_px", "90%", "sigma", "as tracked: rotation, posit_%, turning",
             "true + noise: the same");
  try {
    for (const std::string& name : names) print_row(name);
  } catch (const std::exception& error) {
    fmt::print(stderr, "reconstruction_error_budget: {}\n", error.what());
    return static_cast<int>(ExitCode::kUsage);
  }
  return static_cast<int>(ExitCode::kOk);
}
