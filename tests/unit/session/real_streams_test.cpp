// SPDX-License-Identifier: BSD-3-Clause
// Unsynchronised streams of a real motion-capture system and a real camera (data/README.md of the
// shared data): both metric, so what is found of the scale tells how good the rest is.
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/session/estimate.hpp"

namespace handeye {
namespace {

struct StampedPose {
  std::int64_t timestamp_ns{0};
  Pose pose{Pose::Identity()};
};

/// Rows t [s since 1970], x y z [m], qx qy qz qw. Empty: not there.
std::vector<StampedPose> read_stream(const std::filesystem::path& path) {
  std::vector<StampedPose> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::array<double, 8> v{};
    std::stringstream fields(line);
    std::string field;
    for (double& value : v) {
      if (!std::getline(fields, field, ',')) return {};
      value = std::stod(field);
    }
    rows.push_back(
        {std::llround(v[0] * 1e9),
         make_pose({v[7], v[4], v[5], v[6]}, 1000.0 * Eigen::Vector3d(v[1], v[2], v[3]))});
  }
  return rows;
}

struct Streams {
  PoseBuffer hand{{.capacity = 8192}};
  std::vector<RegisteredFrame> frames;
};

std::optional<Streams> real_streams() {
  const char* configured = std::getenv("HANDEYE_DATA");
  const std::filesystem::path data = configured ? configured : HANDEYE_SOURCE_DIR "/../shared/data";
  Streams streams;
  for (const auto& [time_ns, room_from_hand] : read_stream(data / "streams/vicon_hand.csv")) {
    HandSample sample;
    sample.timestamp_ns = time_ns;
    sample.tracked = true;
    sample.room_from_hand = room_from_hand;
    streams.hand.push(sample);
  }
  for (const auto& [time_ns, scene_from_eye] : read_stream(data / "streams/camera_eye.csv")) {
    RegisteredFrame frame;
    frame.timestamp_ns = time_ns;
    frame.eye_from_scene = scene_from_eye.inverse();
    streams.frames.push_back(frame);
  }
  if (streams.hand.size() == 0 || streams.frames.empty()) return std::nullopt;
  return streams;
}

class RealStreams : public testing::Test {
 protected:
  void SetUp() override {
    streams_ = real_streams();
    if (!streams_) GTEST_SKIP() << "no streams/ in the shared data";
  }
  std::optional<Streams> streams_;
};

/// The camera's stamps are 20 to 28 ms behind the hand's.
TEST_F(RealStreams, TheFreeScaleIsOneAtTheOffsetThatCorrelationFinds) {
  const Estimate found = estimate(streams_->frames, streams_->hand, {});
  ASSERT_TRUE(found.correlation);
  const double offset_s = found.correlation->time_offset_s;
  EXPECT_GT(offset_s, -0.030);
  EXPECT_LT(offset_s, -0.020);
  EXPECT_GT(found.correlation->confidence, 0.5);

  MaximumLikelihoodOptions options;
  options.estimate_scale = true;
  const auto answer =
      maximum_likelihood(observe(streams_->frames, streams_->hand, offset_s), options);
  ASSERT_TRUE(answer);
  const double scale = answer->solution.scale_units_per_mm;
  RecordProperty("offset_ms", std::to_string(1e3 * offset_s));
  RecordProperty("scale", std::to_string(scale));
  EXPECT_GT(scale, 0.97);
  EXPECT_LT(scale, 1.03);
  EXPECT_LT(std::abs(std::log(scale)), 3 * answer->log_scale_sigma) << "an honest sigma";
  EXPECT_LT(answer->log_scale_sigma, 0.02) << "and one that says something";
}

TEST_F(RealStreams, RefiningTheOffsetAgreesAndKeepsTheScale) {
  const Estimate found = estimate(streams_->frames, streams_->hand, {});
  ASSERT_TRUE(found.correlation && found.likelihood);
  const double scale = found.likelihood->solution.scale_units_per_mm;
  RecordProperty("offset_ms", std::to_string(1e3 * found.time_offset_s));
  RecordProperty("scale", std::to_string(scale));
  EXPECT_GT(scale, 0.97);
  EXPECT_LT(scale, 1.03);
  EXPECT_LT(std::abs(std::log(scale)), 3 * found.likelihood->log_scale_sigma);
  EXPECT_LT(std::abs(found.time_offset_s - found.correlation->time_offset_s),
            2 * std::hypot(found.time_offset_sigma_s, found.correlation->sigma_s));
  const Eigen::Vector3d published_mm(66, 42, 30);
  EXPECT_LT((found.likelihood->solution.hand_from_eye.translation() - published_mm).norm(),
            3 * found.likelihood->sigma_translation_mm());
}

}  // namespace
}  // namespace handeye
