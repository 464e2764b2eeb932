// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/disturbance.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/unit/simulator/disturbed_world.hpp"

namespace handeye::simulator {
namespace {

TEST(Disturbance, EveryNameSwitchesItselfOnAndNothingElse) {
  EXPECT_EQ(describe({}), "none");
  for (const std::string_view name : disturbance_names()) {
    Disturbances disturbances;
    EXPECT_TRUE(add_disturbance(name, disturbances));
    EXPECT_EQ(describe(disturbances), name);
  }
  Disturbances both;
  add_disturbance("missing", both);
  add_disturbance("flicker", both);
  EXPECT_EQ(describe(both), "flicker,missing");
  EXPECT_FALSE(add_disturbance("fog", both));
  EXPECT_FALSE(add_disturbance("", both));
}

TEST(Disturbance, NoneIsWhatTheRendererDraws) {
  SimulatorOptions options;
  options.seed = 3;
  options.width = 320;
  options.height = 240;
  const World world(options, 0);
  EndoscopeView view(world);
  Renderer renderer(world.surface, world.camera, options.seed);
  for (const std::uint32_t number : {0U, 1U, 77U}) {
    cv::Mat plain;
    renderer.render(world.motion.surface_from_eye(number / options.camera_rate_hz), number, plain);
    EXPECT_EQ(cv::norm(drawn(view, number), plain, cv::NORM_INF), 0.0);
  }
}

TEST(Disturbance, AllTogetherDoNotDependOnTheOrderOfFrames) {
  SimulatorOptions options = quiet_options(3);
  options.width = 320;
  options.height = 240;
  for (const std::string_view name : disturbance_names()) {
    if (name != "dark") add_disturbance(name, options.disturbances);
  }
  const World world(options, 0);
  EndoscopeView forwards(world);
  EndoscopeView backwards(world);
  const cv::Mat1b first = drawn(forwards, 4);
  const cv::Mat1b second = drawn(forwards, 71);
  EXPECT_EQ(cv::norm(drawn(backwards, 71), second, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(drawn(backwards, 4), first, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(first, second, cv::NORM_INF), 50.0);
}

TEST(Disturbance, InterlacedLinesAreHalfAFrameApart) {
  SimulatorOptions options = quiet_options(6);
  options.image_noise_grey = 0;
  options.scene = SceneKind::kTissue;
  options.camera_rate_hz = 50;
  const World fields(options, 0);
  options.camera_rate_hz = 25;
  options.disturbances.interlaced = true;
  const World woven(options, 0);
  EndoscopeView field_view(fields);
  EndoscopeView woven_view(woven);
  const cv::Mat1b frame = drawn(woven_view, 10);
  const cv::Mat1b even = drawn(field_view, 20);
  const cv::Mat1b odd = drawn(field_view, 21);
  EXPECT_GT(cv::norm(even, odd, cv::NORM_L1) / static_cast<double>(frame.total()), 2.0);
  for (int row = 0; row < frame.rows; ++row) {
    const cv::Mat1b& field = row % 2 == 0 ? even : odd;
    ASSERT_EQ(cv::norm(frame.row(row), field.row(row), cv::NORM_INF), 0.0) << row;
  }
}

TEST(Disturbance, LensIsAsAskedAndTheRestOfTheCameraAsDrawn) {
  SimulatorOptions options = quiet_options(6);
  const CameraModel drawn_camera = World(options, 0).camera;
  options.lens = {-0.3, 0.05};
  const CameraModel camera = World(options, 0).camera;
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{-0.3, 0.05, 0, 0, 0}));
  EXPECT_EQ(camera.fx, drawn_camera.fx);
  EXPECT_EQ(camera.cy, drawn_camera.cy);
}

}  // namespace
}  // namespace handeye::simulator
