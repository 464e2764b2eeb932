// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/scene_start.hpp"
#include "daemon/reconstruction/start_consensus.hpp"
#include "daemon/reconstruction/start_search.hpp"
#include "daemon/reconstruction/start_window.hpp"
#include "tests/unit/reconstruction/synthetic_stretch.hpp"

namespace handeye {
namespace {

using test::records_of;
using test::stretch;
using test::SyntheticOptions;
using test::SyntheticTracks;

bool is_right(const Scene& scene, const SyntheticTracks& truth, double rotation_deg = 1.0,
              double centre = 0.25) {
  std::vector<RegisteredFrame> frames;
  for (const Keyframe& keyframe : scene.keyframes) {
    RegisteredFrame frame;
    frame.index = keyframe.frame_index;
    frame.eye_from_scene = keyframe.eye_from_scene;
    frames.push_back(frame);
  }
  const auto error = test::compare(frames, truth.eye_from_room);
  return error.rotation_rms_deg < rotation_deg && error.centre_rms < centre * error.extent;
}

struct Starts {
  int right{0}, wrong{0}, refused{0};
};

Starts try_starts(const test::Motion& motion, const SyntheticOptions& options, unsigned seeds) {
  Starts starts;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const SyntheticTracks tracks = stretch(motion, options, seed);
    const StartAttempt attempt = start_scene(tracks.camera, {}, records_of(tracks));
    if (!attempt.scene) {
      ++starts.refused;
    } else {
      ++(is_right(*attempt.scene, tracks) ? starts.right : starts.wrong);
    }
  }
  return starts;
}

TEST(StartWindow, HoldsTheFeaturesThatAllItsFramesShow) {
  const SyntheticTracks tracks = stretch(test::free_hand(), {}, 1);
  auto records = records_of(tracks);
  records[10].observations.clear();  // a dark frame is passed over
  const StartWindow window = make_start_window(tracks.camera, records, 8);
  EXPECT_GE(window.frame_count(), 6);
  EXPECT_LE(window.frame_count(), 8);
  EXPECT_EQ(window.frames.front(), &records.front());
  EXPECT_EQ(window.frames.back(), &records.back());
  EXPECT_EQ(window.feature_count(), static_cast<Eigen::Index>(window.features.size()));
  EXPECT_GE(window.feature_count(), 40);
  for (const FrameRecord* frame : window.frames) EXPECT_NE(frame->index, 10);
  const CameraModel& camera = tracks.camera;
  for (Eigen::Index p = 0; p < window.feature_count(); ++p) {
    const Eigen::Vector3d ray = window.rays.col(p).tail<2>().homogeneous();
    EXPECT_LT((project<double>(camera, ray) - window.pixels.col(p).tail<2>()).norm(), 1e-3);
  }
}

TEST(StartConsensus, LeavesOutAnInstrument) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    SyntheticOptions options;
    options.outlier_tracks = 0;
    const SyntheticTracks scene = stretch(test::orbit(), options, seed);
    const auto records = records_of(scene);
    StartWindow window = make_start_window(scene.camera, records, 8);
    // Every third track belongs to another body, with an affine movement of its own.
    const Eigen::Index count = window.feature_count();
    for (Eigen::Index p = 0; p < count; p += 3) {
      for (Eigen::Index f = 1; f < window.frame_count(); ++f) {
        const double t = 0.1 * static_cast<double>(f);
        const Eigen::Vector2d first = window.rays.col(p).head<2>();
        window.rays.col(p).segment<2>(2 * f) =
            Eigen::Rotation2Dd(t) * first + Eigen::Vector2d(0.5 * t, -0.7 * t);
      }
    }
    int others = 0;
    int own = 0;
    for (const Eigen::Index column : consistent_tracks(window.rays, 1.0 / 560.0)) {
      ++(column % 3 == 0 ? others : own);
    }
    EXPECT_GT(own, 0.8 * 2.0 / 3.0 * static_cast<double>(count)) << "seed " << seed;
    EXPECT_LE(others, 0.05 * static_cast<double>(count)) << "seed " << seed;
  }
}

TEST(SceneStart, IsRightInFrontOfRelief) {
  for (const auto& motion : {test::free_hand(), test::orbit()}) {
    const Starts starts = try_starts(motion, {}, 10);
    EXPECT_EQ(starts.wrong, 0);
    EXPECT_GE(starts.right, 6);
  }
}

TEST(SceneStart, IsNeverWrongInFrontOfAPlane) {
  SyntheticOptions options;
  options.relief_mm = 0;
  const Starts starts = try_starts(test::free_hand(), options, 10);
  EXPECT_EQ(starts.wrong, 0);
  EXPECT_GE(starts.right, 4);
}

TEST(SceneStart, IsNeverWrongWithAnInstrumentOverAThird) {
  SyntheticOptions options;
  options.instrument_share = 0.33;
  const Starts starts = try_starts(test::free_hand(), options, 10);
  EXPECT_EQ(starts.wrong, 0);
  EXPECT_GE(starts.right, 4);
}

TEST(SceneStart, RefusesATurningOrStandingScopeWithAMovingInstrument) {
  SyntheticOptions options;
  options.instrument_share = 0.33;
  for (const double still : {0.0, 1.0}) {
    const test::Motion motion = [still](double time_s) {
      return test::turning_only()((1.0 - still) * time_s);
    };
    EXPECT_EQ(try_starts(motion, options, 6).refused, 6) << "still " << still;
  }
}

TEST(SceneStart, IsNotFoundInTheWholeSequenceOfATurningScopeWithAnInstrument) {
  for (const unsigned seed : {2U, 7U, 8U}) {
    SyntheticOptions options;
    options.instrument_share = seed == 2 ? 0.2 : 0.33;
    options.seed = seed;
    options.frames = 150;
    const SyntheticTracks tracks = test::synthesize(
        options, [seed](double time_s) { return test::turning_only()(time_s + 0.37 * seed); });
    const ReconstructionOptions reconstruction;
    StartSearch search(tracks.camera, reconstruction);
    std::vector<FrameRecord> seen;
    for (FrameRecord& record : records_of(tracks)) {
      seen.push_back(std::move(record));
      ASSERT_FALSE(search.look(seen).scene) << "seed " << seed << " frame " << seen.size();
    }
  }
}

TEST(SceneStart, SaysWhyItRefuses) {
  const SyntheticTracks turning = stretch(test::turning_only(), {}, 1);
  EXPECT_EQ(start_scene(turning.camera, {}, records_of(turning)).state,
            ReconstructionState::kNoParallax);
  const SyntheticTracks still = stretch([](double) { return test::free_hand()(0.0); }, {}, 1);
  EXPECT_EQ(start_scene(still.camera, {}, records_of(still)).state, ReconstructionState::kNoMotion);
}

TEST(SceneStart, IsRightOrRefusedForwards) {
  const Starts starts = try_starts(test::forward(), {}, 10);
  EXPECT_EQ(starts.wrong, 0);
}

}  // namespace
}  // namespace handeye
