// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_choice.hpp"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "daemon/reconstruction/scene_start.hpp"
#include "daemon/reconstruction/start_candidate.hpp"
#include "tests/unit/reconstruction/synthetic_stretch.hpp"

namespace handeye {
namespace {

using test::records_of;
using test::stretch;
using test::SyntheticTracks;

/// The poses that a camera had in the window; of the frames between the ends only on request.
StartHypothesis true_poses(const StartWindow& window, const SyntheticTracks& truth, bool between) {
  StartHypothesis hypothesis{StartMethod::kTwoViews, {}};
  for (const FrameRecord* frame : window.frames) {
    hypothesis.eye_from_scene.emplace_back(std::nullopt);
    const bool end = frame == window.frames.front() || frame == window.frames.back();
    if (!end && !between) continue;
    hypothesis.eye_from_scene.back() = truth.eye_from_room[static_cast<std::size_t>(frame->index)];
  }
  return hypothesis;
}

TEST(StartCandidate, GainsNothingFromFramesItDoesNotExplain) {
  const SyntheticTracks tracks = stretch(test::free_hand(), {}, 3);
  const auto records = records_of(tracks);
  const StartWindow window = make_start_window(tracks.camera, records, 8);
  ASSERT_EQ(window.frame_count(), 8);
  std::vector<StartCandidate> candidates;
  for (const bool between : {true, false}) {
    const StartHypothesis hypothesis = true_poses(window, tracks, between);
    candidates.push_back(make_candidate(tracks.camera, {}, window, hypothesis, 80));
    adjust_candidate(tracks.camera, {}, candidates.back());
  }
  // Two views fit whatever they show; six of the eight frames are left unexplained.
  EXPECT_LE(candidates[1].inlier_ratio, 0.25);
  const double least_px = ReconstructionOptions{}.max_reprojection_px * std::sqrt(6.0 / 8.0);
  EXPECT_GE(candidates[1].error_px, least_px);
  EXPECT_EQ(choose_start(candidates), 0U);
  EXPECT_FALSE(same_solution(candidates[0].scene, candidates[1].scene));
  const StartCandidate complete = complete_candidate(tracks.camera, {}, window, candidates[1]);
  EXPECT_GE(complete.error_px, least_px);
}

TEST(StartChoice, IsNotMadeBetweenEquals) {
  const SyntheticTracks tracks = stretch(test::free_hand(), {}, 3);
  const auto records = records_of(tracks);
  const StartAttempt attempt = start_scene(tracks.camera, {}, records);
  ASSERT_TRUE(attempt.scene);
  StartCandidate found;
  found.scene = *attempt.scene;
  found.error_px = 0.5;
  StartCandidate other = found;
  other.error_px = 0.55;
  EXPECT_EQ(choose_start({found, other}), 0U);  // the same solution twice
  for (Keyframe& keyframe : other.scene.keyframes) {
    keyframe.eye_from_scene.linear() =
        exp_so3(log_so3(keyframe.eye_from_scene.linear()).cwiseProduct(Eigen::Vector3d(-1, -1, 1)));
  }
  EXPECT_FALSE(same_solution(found.scene, other.scene));
  EXPECT_FALSE(choose_start({found, other}));
  other.error_px = 0.7;
  EXPECT_EQ(choose_start({other, found}), 1U);
}

}  // namespace
}  // namespace handeye
