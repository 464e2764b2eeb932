// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/reconstruction.hpp"

#include <array>

#include <gtest/gtest.h>

#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace handeye {
namespace {

using test::SyntheticOptions;
using test::SyntheticTracks;

Reconstruction reconstruct(const SyntheticTracks& tracks) {
  IncrementalReconstruction reconstruction(tracks.camera);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  return reconstruction.finish();
}

class FreeHand : public testing::TestWithParam<unsigned> {};

TEST_P(FreeHand, IsRecoveredUpToASimilarity) {
  SyntheticOptions options;
  options.seed = GetParam();
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  const Reconstruction result = reconstruct(tracks);
  ASSERT_EQ(result.state, ReconstructionState::kTracking);
  EXPECT_EQ(result.frames.size(), tracks.frames.size());
  EXPECT_LT(result.reprojection_px, 1.0);
  const auto error = test::compare(result.frames, tracks.eye_from_room);
  RecordProperty("rotation_rms_deg", std::to_string(error.rotation_rms_deg));
  EXPECT_LT(error.rotation_rms_deg, 0.1);
  EXPECT_LT(error.centre_rms, 0.02 * error.extent);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FreeHand, testing::Range(1U, 6U));

TEST(Reconstruction, RecoversAMotionInFrontOfAPlane) {
  SyntheticOptions options;
  options.relief_mm = 0;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  const Reconstruction result = reconstruct(tracks);
  ASSERT_EQ(result.state, ReconstructionState::kTracking);
  EXPECT_EQ(result.frames.size(), tracks.frames.size());
  EXPECT_LT(test::compare(result.frames, tracks.eye_from_room).rotation_rms_deg, 0.15);
}

TEST(Reconstruction, IsBitIdenticalFromRunToRun) {
  SyntheticOptions options;
  options.frames = 100;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  const Reconstruction first = reconstruct(tracks);
  const Reconstruction second = reconstruct(tracks);
  ASSERT_EQ(first.frames.size(), second.frames.size());
  ASSERT_FALSE(first.frames.empty());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    EXPECT_EQ(first.frames[i].eye_from_scene.matrix(), second.frames[i].eye_from_scene.matrix());
  }
  EXPECT_EQ(first.reprojection_px, second.reprojection_px);
}

TEST(Reconstruction, SaysNoMotionOfAStandingScope) {
  SyntheticOptions options;
  options.frames = 60;
  const SyntheticTracks tracks =
      test::synthesize(options, [](double) { return test::free_hand()(0.0); });
  const Reconstruction result = reconstruct(tracks);
  EXPECT_EQ(result.state, ReconstructionState::kNoMotion);
  EXPECT_TRUE(result.frames.empty());
}

TEST(Reconstruction, SaysNoParallaxOfATurningScope) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SyntheticOptions options;
    options.seed = seed;
    const SyntheticTracks tracks = test::synthesize(options, test::turning_only());
    const Reconstruction result = reconstruct(tracks);
    EXPECT_EQ(result.state, ReconstructionState::kNoParallax) << "seed " << seed;
    EXPECT_TRUE(result.frames.empty());
  }
}

TEST(Reconstruction, SaysTooFewFeaturesOfStills) {
  SyntheticOptions options;
  options.frames = 8;
  options.death_rate = 1.0;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  EXPECT_EQ(reconstruct(tracks).state, ReconstructionState::kTooFewFeatures);
}

TEST(Reconstruction, ReturnsBothPartsAfterALossOfTracking) {
  SyntheticOptions options;
  options.frames = 240;
  options.blind_frame = 90;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  const Reconstruction result = reconstruct(tracks);
  ASSERT_EQ(result.state, ReconstructionState::kTracking);
  EXPECT_EQ(result.parts, 2);
  ASSERT_EQ(result.frames.size(), 240U);
  std::array<std::vector<RegisteredFrame>, 2> parts;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    EXPECT_EQ(result.frames[i].index, static_cast<std::int64_t>(i));
    parts.at(static_cast<std::size_t>(result.frames[i].part)).push_back(result.frames[i]);
  }
  EXPECT_EQ(parts[0].size(), 150U);
  for (const auto& part : parts) {
    EXPECT_LT(test::compare(part, tracks.eye_from_room).rotation_rms_deg, 0.1);
  }
}

TEST(Reconstruction, GoesOnAfterFinish) {
  SyntheticOptions options;
  options.frames = 120;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  IncrementalReconstruction reconstruction(tracks.camera);
  for (int f = 0; f < 80; ++f) reconstruction.add(tracks.frames[static_cast<std::size_t>(f)]);
  EXPECT_EQ(reconstruction.finish().frames.size(), 80U);
  for (int f = 80; f < 120; ++f) reconstruction.add(tracks.frames[static_cast<std::size_t>(f)]);
  const Reconstruction result = reconstruction.finish();
  EXPECT_EQ(result.frames.size(), 120U);
  EXPECT_LT(test::compare(result.frames, tracks.eye_from_room).rotation_rms_deg, 0.1);
}

TEST(Reconstruction, ThinsKeyframesAboveTheLimit) {
  SyntheticOptions options;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  ReconstructionOptions few;
  few.max_keyframes = 25;
  IncrementalReconstruction reconstruction(tracks.camera, few);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  // Some more may have been made while an adjustment is under way.
  EXPECT_LE(reconstruction.keyframes(), 25 + 5);
  const Reconstruction result = reconstruction.finish();
  EXPECT_LE(reconstruction.keyframes(), 25);
  EXPECT_EQ(result.frames.size(), tracks.frames.size());
  EXPECT_LT(test::compare(result.frames, tracks.eye_from_room).rotation_rms_deg, 0.3);
}

}  // namespace
}  // namespace handeye
