// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "daemon/reconstruction/reconstruction.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace handeye {
namespace {

using test::SyntheticOptions;
using test::SyntheticTracks;

Reconstruction reconstruct(const SyntheticTracks& tracks,
                           const ReconstructionOptions& options = {}) {
  IncrementalReconstruction reconstruction(tracks.camera, options);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  return reconstruction.finish();
}

void expect_same(const Reconstruction& a, const Reconstruction& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  ASSERT_FALSE(a.frames.empty());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].eye_from_scene.matrix(), b.frames[i].eye_from_scene.matrix()) << i;
  }
  EXPECT_EQ(a.reprojection_px, b.reprojection_px);
}

SyntheticOptions blind_for_a_second() {
  SyntheticOptions options;
  options.frames = 240;
  options.blind_frame = 110;
  options.blind_frames = 25;
  return options;
}

TEST(Recovery, FindsTheSceneAgainByWhatItLooksLike) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SyntheticOptions options = blind_for_a_second();
    options.described = true;
    options.seed = seed;
    const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
    const Reconstruction result = reconstruct(tracks);
    EXPECT_EQ(result.parts, 1) << "seed " << seed;
    EXPECT_GE(result.frames.size(), 240U - 25U - 2U) << "seed " << seed;
    const auto error = test::compare(result.frames, tracks.eye_from_room);
    EXPECT_LT(error.rotation_rms_deg, 0.1) << "seed " << seed;
    EXPECT_LT(error.centre_rms, 0.02 * error.extent) << "seed " << seed;
  }
}

TEST(Recovery, BeginsASecondPartWhereNothingIsRecognised) {
  const SyntheticTracks tracks = test::synthesize(blind_for_a_second(), test::free_hand());
  const Reconstruction result = reconstruct(tracks);
  EXPECT_EQ(result.parts, 2);
  EXPECT_EQ(result.frames.front().part, 0) << "the first has more frames";
  EXPECT_EQ(result.frames.back().part, 1);
}

TEST(Recovery, PassesOverDarkFramesThatFeaturesOutlast) {
  SyntheticOptions options;
  options.frames = 120;
  SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  for (std::size_t f = 60; f < 72; ++f) {
    tracks.frames[f].observations.clear();
    tracks.frames[f].condition = ImageCondition::kDark;
  }
  const Reconstruction result = reconstruct(tracks);
  EXPECT_EQ(result.parts, 1);
  EXPECT_EQ(result.frames.size(), 108U);
  EXPECT_LT(test::compare(result.frames, tracks.eye_from_room).rotation_rms_deg, 0.1);
}

TEST(Instrument, DoesNotTakeOver) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SyntheticOptions options;
    options.instrument_share = 1.0 / 3.0;
    options.seed = seed;
    const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
    const Reconstruction result = reconstruct(tracks);
    ASSERT_EQ(result.state, ReconstructionState::kTracking) << "seed " << seed;
    EXPECT_EQ(result.parts, 1);
    EXPECT_GE(result.frames.size(), 190U) << "seed " << seed;
    const auto error = test::compare(result.frames, tracks.eye_from_room);
    EXPECT_LT(error.rotation_rms_deg, 0.15) << "seed " << seed;
    EXPECT_LT(error.rotation_max_deg, 0.5) << "seed " << seed;
  }
}

TEST(Background, ChangesNothingButTime) {
  SyntheticOptions options = blind_for_a_second();
  options.described = true;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  ReconstructionOptions in_turn;
  in_turn.background = false;
  expect_same(reconstruct(tracks), reconstruct(tracks, in_turn));
}

TEST(Memory, OlderFramesGiveUpWhatTheyShowedButStayWhereTheyAre) {
  SyntheticOptions options;
  options.frames = 600;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  ReconstructionOptions little;
  little.max_observed_frames = 300;
  const Reconstruction result = reconstruct(tracks, little);
  EXPECT_EQ(result.frames.size(), tracks.frames.size());
  const auto error = test::compare(result.frames, tracks.eye_from_room);
  const Reconstruction unbounded = reconstruct(tracks);
  const auto without_bound = test::compare(unbounded.frames, tracks.eye_from_room);
  EXPECT_LT(error.rotation_rms_deg, 1.1 * without_bound.rotation_rms_deg);
  EXPECT_LT(error.rotation_max_deg, 0.5);
  EXPECT_LT(error.centre_rms, 1.1 * without_bound.centre_rms);
}

}  // namespace
}  // namespace handeye
