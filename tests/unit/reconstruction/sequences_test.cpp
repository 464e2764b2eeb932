// SPDX-License-Identifier: BSD-3-Clause
// Tracker and reconstruction on rendered sequences, one for each thing that makes an endoscope's
// pictures hard; the camera is given.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/tracking_stage.hpp"
#include "tests/sequences/pose_error.hpp"
#include "tests/sequences/sequence.hpp"

namespace handeye::sequences {
namespace {

/// Frames of the largest part beside the truth.
struct Outcome {
  std::int64_t frames{0};  ///< drawn
  std::vector<PosePair> registered;
};

Outcome reconstruct(Sequence& sequence) {
  TrackingStage tracking{cv::Mat()};
  IncrementalReconstruction reconstruction(sequence.camera());
  Outcome outcome;
  SequenceFrame drawn;
  Frame frame;
  TrackedFrame tracked;
  while (sequence.next(drawn)) {
    frame.grey = drawn.grey;
    frame.timestamp_ns = drawn.timestamp_ns;
    tracking.process(frame, tracked);
    reconstruction.add(tracked);
    ++outcome.frames;
  }
  for (const RegisteredFrame& registered : reconstruction.finish().frames) {
    if (registered.part != 0) continue;
    outcome.registered.push_back(
        {sequence.scene_from_eye(registered.timestamp_ns), registered.eye_from_scene.inverse()});
  }
  return outcome;
}

class SequencesTest : public testing::TestWithParam<std::string_view> {};

TEST_P(SequencesTest, EveryCameraPoseIsRight) {
  Sequence sequence(GetParam());
  const Outcome outcome = reconstruct(sequence);
  EXPECT_GE(static_cast<double>(outcome.registered.size()),
            0.95 * static_cast<double>(outcome.frames));
  const auto error = pose_error(outcome.registered, sequence.scene_distance_mm());
  ASSERT_TRUE(error.has_value());
  fmt::print(
      "{}: {} of {} frames; rotation {:.3f} deg rms, {:.3f} worst; position {:.3f} % rms, {:.3f} "
      "worst; orientations alone {:.3f} deg rms, {:.3f} worst\n",
      GetParam(), outcome.registered.size(), outcome.frames, error->rotation_rms_deg,
      error->rotation_worst_deg, 100 * error->position_rms, 100 * error->position_worst,
      error->turning_rms_deg, error->turning_worst_deg);
  EXPECT_LT(error->rotation_rms_deg, 0.15);
  EXPECT_LT(error->position_rms, 0.005);
  EXPECT_LT(error->rotation_worst_deg, 0.15);
  EXPECT_LT(error->position_worst, 0.005);
}

INSTANTIATE_TEST_SUITE_P(MustHave, SequencesTest,
                         testing::ValuesIn(must_have_names().begin(), must_have_names().end()),
                         [](const auto& sequence) { return std::string(sequence.param); });

}  // namespace
}  // namespace handeye::sequences
