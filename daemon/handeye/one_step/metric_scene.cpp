// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/metric_scene.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "daemon/geometry/projection.hpp"
#include "daemon/handeye/one_step/sound_problem.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

constexpr std::size_t kFewestHands = 3;
constexpr std::size_t kFewestKeyframes = 2;         // of a part: one alone has no scene
constexpr std::size_t kFewestPointsOfKeyframe = 6;  // three determine a pose, barely
constexpr double kLeastParallax_rad = 1e-3;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// A part's scene in the room.
struct Placement {
  Pose room_from_scene{Pose::Identity()};  ///< scene in mm, room counted from the centre
  double mm_per_unit{1};

  Eigen::Vector3d point(const Eigen::Vector3d& point_scene) const {
    return room_from_scene * (mm_per_unit * point_scene);
  }
  Pose eye(const Pose& eye_from_scene) const {
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() = room_from_scene.linear() * eye_from_scene.linear().transpose();
    room_from_eye.translation() = point(eye_from_scene.inverse().translation());
    return room_from_eye;
  }
};

const PartResult* used_part(const MaximumLikelihoodResult& start, int number) {
  const auto found = std::ranges::find(start.parts, number, &PartResult::number);
  return found == start.parts.end() || found->poses_used == 0 ? nullptr : &*found;
}

/// The covariance of (w, dt) of eye_from_scene [scene units] as that of (w, dC) of room_from_eye.
Matrix6d in_room(const Matrix6d& of_eye_from_scene, const Pose& eye_from_scene,
                 const Pose& room_from_eye, double mm_per_unit) {
  Matrix6d by_eye = Matrix6d::Zero();
  by_eye.topLeftCorner<3, 3>() = -room_from_eye.linear();
  by_eye.bottomLeftCorner<3, 3>() =
      -mm_per_unit * room_from_eye.linear() * skew(eye_from_scene.translation());
  by_eye.bottomRightCorner<3, 3>() = -mm_per_unit * room_from_eye.linear();
  return by_eye * of_eye_from_scene * by_eye.transpose();
}

class SceneBuilder {
 public:
  SceneBuilder(const OneStepProblem& problem, const MaximumLikelihoodResult& start)
      : problem_(problem), start_(start), left_out_(problem.frames.size(), false) {}

  std::optional<MetricScene> build() {
    find_centre();
    do {
      choose_keyframes();
      if (scene_.keyframes_at_start.empty()) return std::nullopt;
      add_points();
    } while (leave_out_keyframes());
    for (std::size_t k = 0; k < problem_.frames.size(); ++k) add_frame(k);
    const auto hands = std::ranges::count_if(
        scene_.frames, [](const MetricFrame& frame) { return frame.hand.has_value(); });
    if (static_cast<std::size_t>(hands) < kFewestHands || scene_.points() == 0) return std::nullopt;
    scene_.start.hand_from_eye = start_.solution.hand_from_eye;
    scene_.start.camera = problem_.camera;
    scene_.start.room_from_eye = scene_.keyframes_at_start;
    return std::move(scene_);
  }

 private:
  void find_centre() {
    double hands = 0;
    for (const OneStepFrame& frame : problem_.frames) {
      if (!frame.hand) continue;
      scene_.centre_mm += frame.hand->room_from_hand.translation();
      ++hands;
    }
    if (hands > 0) scene_.centre_mm /= hands;
  }

  std::optional<Placement> placement(int part) const {
    const PartResult* used = used_part(start_, part);
    if (used == nullptr || !(used->scale_units_per_mm > 0)) return std::nullopt;
    Placement result{used->room_from_scene, 1.0 / used->scale_units_per_mm};
    result.room_from_scene.translation() -= scene_.centre_mm;
    return result;
  }

  /// Those that are not left out, in parts that have enough of them.
  void choose_keyframes() {
    keyframe_of_.assign(problem_.frames.size(), kNone);
    frames_of_keyframes_.clear();
    part_numbers_.clear();
    scene_.keyframes_of_parts.clear();
    scene_.keyframes_at_start.clear();
    std::vector<std::vector<std::size_t>> frames_of_parts(start_.parts.size());
    for (std::size_t k = 0; k < problem_.frames.size(); ++k) {
      const OneStepFrame& frame = problem_.frames[k];
      if (!frame.keyframe || left_out_[k] || !placement(frame.part)) continue;
      const PartResult* part = used_part(start_, frame.part);
      frames_of_parts[static_cast<std::size_t>(part - start_.parts.data())].push_back(k);
    }
    for (const std::vector<std::size_t>& frames : frames_of_parts) {
      if (frames.size() < kFewestKeyframes) continue;
      const OneStepFrame& first = problem_.frames[frames.front()];
      part_numbers_.push_back(first.part);
      std::vector<std::size_t>& keyframes = scene_.keyframes_of_parts.emplace_back();
      for (const std::size_t k : frames) {
        keyframe_of_[k] = scene_.keyframes_at_start.size();
        keyframes.push_back(keyframe_of_[k]);
        scene_.keyframes_at_start.push_back(
            placement(first.part)->eye(problem_.frames[k].eye_from_scene));
      }
      frames_of_keyframes_.insert(frames_of_keyframes_.end(), frames.begin(), frames.end());
    }
  }

  void add_points() {
    scene_.observations.clear();
    scene_.first_of_point.clear();
    scene_.start.points_mm.clear();
    for (const OneStepPoint& point : problem_.points) add_point(point);
  }

  /// Those that see too few of the points that are in use; whether there are any.
  bool leave_out_keyframes() {
    std::vector<std::size_t> seen(scene_.keyframes(), 0);
    for (const MetricObservation& observation : scene_.observations) ++seen[observation.keyframe];
    bool any = false;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      if (seen[k] >= kFewestPointsOfKeyframe) continue;
      left_out_[frames_of_keyframes_[k]] = any = true;
    }
    return any;
  }

  void add_frame(std::size_t k) {
    const OneStepFrame& given = problem_.frames[k];
    const auto part = std::ranges::find(part_numbers_, given.part);
    const bool keyframe = keyframe_of_[k] != kNone;
    // A keyframe that is not in use has no pose of its own that its covariance would speak of.
    if (part == part_numbers_.end() || (given.keyframe && !keyframe)) return;
    MetricFrame frame{.frame = k,
                      .part = static_cast<std::size_t>(part - part_numbers_.begin()),
                      .keyframe = keyframe,
                      .hand = given.hand};
    const Placement placed = *placement(given.part);
    frame.room_from_eye_start = placed.eye(given.eye_from_scene);
    if (keyframe) {
      frame.before = frame.after = keyframe_of_[k];
    } else {
      follow_neighbours(k, frame);
      frame.unit_covariance = in_room(given.unit_covariance, given.eye_from_scene,
                                      frame.room_from_eye_start, placed.mm_per_unit);
      // Zero: how well it was seen is not known, and so not what its hand is worth.
      if (given.unit_covariance.isZero(0)) frame.hand.reset();
    }
    if (frame.hand) frame.hand->room_from_hand.translation() -= scene_.centre_mm;
    scene_.frames.push_back(std::move(frame));
  }

  void follow_neighbours(std::size_t k, MetricFrame& frame) const {
    const std::vector<std::size_t>& keyframes = scene_.keyframes_of_parts[frame.part];
    const auto after = std::ranges::find_if(
        keyframes, [&](std::size_t keyframe) { return frames_of_keyframes_[keyframe] > k; });
    frame.after = after == keyframes.end() ? keyframes.back() : *after;
    frame.before = after == keyframes.begin() ? frame.after : *std::prev(after);
    const std::size_t from = frames_of_keyframes_[frame.before];
    const std::size_t to = frames_of_keyframes_[frame.after];
    // By count, not by time: frames come at a steady rate, and where some were lost between two
    // keyframes it only shifts how what both did beyond the scene's own motion is shared out.
    if (from < to) frame.share = static_cast<double>(k - from) / static_cast<double>(to - from);
  }

  void add_point(const OneStepPoint& point) {
    const auto placed = placement(point.part);
    if (!placed) return;
    const Eigen::Vector3d point_mm = placed->point(point.point_scene);
    const std::size_t begin = scene_.observations.size();
    std::vector<Eigen::Vector3d> rays;
    for (const auto& seen : point.observations) {
      const std::size_t keyframe = keyframe_of_[static_cast<std::size_t>(seen.frame)];
      if (keyframe == kNone) continue;
      const Pose& room_from_eye = scene_.keyframes_at_start[keyframe];
      if (!((room_from_eye.inverse() * point_mm).z() > 0)) continue;
      rays.push_back((point_mm - room_from_eye.translation()).normalized());
      scene_.observations.push_back({keyframe, seen.pixel});
    }
    const bool apart = std::ranges::any_of(rays, [&](const Eigen::Vector3d& ray) {
      return (ray - rays.front()).norm() > kLeastParallax_rad;
    });
    if (!apart) {
      scene_.observations.resize(begin);
      return;
    }
    if (scene_.first_of_point.empty()) scene_.first_of_point.push_back(0);
    scene_.start.points_mm.push_back(point_mm);
    scene_.first_of_point.push_back(scene_.observations.size());
  }

  const OneStepProblem& problem_;
  const MaximumLikelihoodResult& start_;
  std::vector<bool> left_out_;            ///< one a frame
  std::vector<std::size_t> keyframe_of_;  ///< likewise
  std::vector<std::size_t> frames_of_keyframes_;
  std::vector<int> part_numbers_;
  MetricScene scene_;
};

}  // namespace

std::optional<MetricScene> metric_scene(const OneStepProblem& problem,
                                        const MaximumLikelihoodResult& start) {
  if (!is_sound(problem) || !is_usable(start.solution)) return std::nullopt;
  return SceneBuilder(problem, start).build();
}

}  // namespace handeye
