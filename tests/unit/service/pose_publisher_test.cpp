// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/pose_publisher.hpp"

#include <gtest/gtest.h>

namespace handeye {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kStart_ns = 1'000'000 * kMillisecond_ns;
constexpr std::int64_t kOffset_ns = 30 * kMillisecond_ns;  // camera stamp minus tracker stamp
constexpr const char* kChannel = "CAMERA_POSE";

/// A hand that turns and moves steadily, so that interpolation is exact.
Pose room_from_hand_at(std::int64_t tracker_ns) {
  const double t_s = 1e-9 * static_cast<double>(tracker_ns - kStart_ns);
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(t_s * Eigen::Vector3d(0.2, -0.5, 0.3));
  pose.translation() = Eigen::Vector3d(100, 200, 300) + t_s * Eigen::Vector3d(40, -10, 20);
  return pose;
}

Pose pose_of(const camera_pose_t& message) {
  return make_pose({message.q_wxyz[0], message.q_wxyz[1], message.q_wxyz[2], message.q_wxyz[3]},
                   {message.t_mm[0], message.t_mm[1], message.t_mm[2]});
}

class PosePublisherTest : public testing::Test {
 protected:
  PosePublisherTest() {
    bus_.subscribe<camera_pose_t>(kChannel,
                                  [this](const camera_pose_t& pose) { heard_.push_back(pose); });
    calibration_.request_id = 77;
    calibration_.accepted_ns = kStart_ns - 5'000 * kMillisecond_ns;
    calibration_.hand_from_eye =
        make_pose(Eigen::Quaterniond(0.4, -0.5, 0.7, 0.2), Eigen::Vector3d(60, -40, 300));
    calibration_.covariance = Matrix6d::Identity();
    calibration_.time_offset_ns = kOffset_ns;
    calibration_.time_offset_sigma_s = 2e-3;
    calibration_.hand_noise = {.rotation_rad = 0.001, .translation_mm = 0.15};
  }

  void add_hand(std::int64_t at_ms, bool tracked = true) {
    const std::int64_t tracker_ns = kStart_ns + at_ms * kMillisecond_ns;
    HandSample sample;
    sample.timestamp_ns = tracker_ns;
    sample.tracked = tracked;
    sample.room_from_hand = room_from_hand_at(tracker_ns);
    publisher_.add_hand(sample);
  }
  /// A frame whose instant is at_ms on the tracker's time axis; it arrives at once.
  void add_frame(std::int64_t at_ms) {
    publisher_.add_frame({camera_ns(at_ms), at_ms, camera_ns(at_ms)});
  }
  static std::int64_t camera_ns(std::int64_t at_ms) {
    return kStart_ns + at_ms * kMillisecond_ns + kOffset_ns;
  }

  /// What was published until now.
  const std::vector<camera_pose_t>& publish(std::int64_t now_ms) {
    publisher_.publish_ready(camera_ns(now_ms));
    while (bus_.handle(milliseconds(20))) {
    }
    return heard_;
  }
  void expect_invalid(const camera_pose_t& pose, std::int32_t validity) const {
    EXPECT_EQ(pose.validity, validity);
    for (const double value : pose.q_wxyz) EXPECT_EQ(value, 0);
    for (const double value : pose.t_mm) EXPECT_EQ(value, 0);
    for (const double value : pose.covariance) EXPECT_EQ(value, 0);
    EXPECT_EQ(pose.calibration_request_id, calibration_.request_id);
  }

  Bus bus_{"memq://"};
  PosePublisher publisher_{bus_, kChannel};
  ActiveCalibration calibration_;
  std::vector<camera_pose_t> heard_;
};

TEST_F(PosePublisherTest, SaysNothingUntilCalibrated) {
  add_hand(0);
  add_frame(0);
  EXPECT_TRUE(publish(1000).empty());
}

TEST_F(PosePublisherTest, InterpolatesTheHandToTheFramesInstant) {
  publisher_.use(calibration_);
  add_hand(0);
  add_hand(16);
  add_frame(4);
  ASSERT_EQ(publish(20).size(), 1U);
  const camera_pose_t& pose = heard_.front();
  EXPECT_EQ(pose.validity, camera_pose_t::VALID);
  const Pose expected =
      room_from_hand_at(kStart_ns + 4 * kMillisecond_ns) * calibration_.hand_from_eye;
  EXPECT_TRUE(pose_of(pose).isApprox(expected, 1e-9));
  EXPECT_EQ(pose.timestamp_ns, camera_ns(4));
  EXPECT_EQ(pose.frame_seq, 4);
  EXPECT_EQ(pose.calibration_request_id, 77);
  EXPECT_EQ(pose.calibration_age_s, 5);
  // A quarter of the way from one sample to the next, by a hand of known velocity.
  HandEstimate hand;
  hand.room_from_hand = room_from_hand_at(kStart_ns + 4 * kMillisecond_ns);
  hand.covariance = 0.625 * hand_sample_covariance(calibration_.hand_noise);
  hand.angular_velocity = {0.2, -0.5, 0.3};
  hand.velocity = {40, -10, 20};
  const Matrix6d covariance = camera_pose_covariance(hand, calibration_);
  EXPECT_EQ(pose.flags, 0);
  EXPECT_EQ(pose.predicted_s, 0);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      EXPECT_NEAR(pose.covariance[6 * row + column], covariance(row, column), 1e-9);
    }
  }
}

TEST_F(PosePublisherTest, WaitsForTheSampleAfterTheFrame) {
  publisher_.use(calibration_);
  add_hand(0);
  add_frame(4);
  EXPECT_TRUE(publish(20).empty());
  add_hand(16);
  ASSERT_EQ(publish(25).size(), 1U);
  EXPECT_EQ(heard_.front().validity, camera_pose_t::VALID);
}

TEST_F(PosePublisherTest, PublishesFramesInTheirOrderAndEachOnce) {
  publisher_.use(calibration_);
  for (std::int64_t i = 0; i < 5; ++i) add_frame(20 * i + 1);
  for (std::int64_t i = 0; i < 7; ++i) add_hand(16 * i);
  publish(100);
  ASSERT_EQ(publish(110).size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(heard_[i].frame_seq, static_cast<std::int64_t>(20 * i + 1));
    EXPECT_EQ(heard_[i].validity, camera_pose_t::VALID);
  }
}

TEST_F(PosePublisherTest, HiddenHand) {
  publisher_.use(calibration_);
  add_hand(0);
  add_hand(16, false);
  add_hand(32);
  add_frame(4);
  add_frame(20);
  ASSERT_EQ(publish(40).size(), 2U);
  for (const camera_pose_t& pose : heard_) expect_invalid(pose, camera_pose_t::TRACKER_HIDDEN);
}

TEST_F(PosePublisherTest, GapInTheTrackersSamples) {
  publisher_.use(calibration_);
  add_hand(0);
  add_hand(500);
  add_frame(250);
  ASSERT_EQ(publish(510).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_GAP);
}

TEST_F(PosePublisherTest, SamplesThatBeginAfterTheFrame) {
  publisher_.use(calibration_);
  add_hand(32);
  add_hand(48);
  add_frame(4);
  ASSERT_EQ(publish(60).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_GAP);
}

TEST_F(PosePublisherTest, SampleThatDoesNotComeInTime) {
  publisher_.use(calibration_);
  add_hand(0);
  add_frame(4);
  EXPECT_TRUE(publish(150).empty());
  ASSERT_EQ(publish(300).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_LATE);
}

TEST_F(PosePublisherTest, TrackerThatWasNeverHeard) {
  publisher_.use(calibration_);
  add_frame(4);
  EXPECT_TRUE(publish(100).empty());
  ASSERT_EQ(publish(300).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_SILENT);
}

TEST_F(PosePublisherTest, RecoversAfterAnOcclusion) {
  publisher_.use(calibration_);
  for (std::int64_t i = 0; i < 3; ++i) add_hand(16 * i, false);
  for (std::int64_t i = 3; i < 6; ++i) add_hand(16 * i);
  add_frame(20);
  add_frame(60);
  ASSERT_EQ(publish(100).size(), 2U);
  expect_invalid(heard_[0], camera_pose_t::TRACKER_HIDDEN);
  EXPECT_EQ(heard_[1].validity, camera_pose_t::VALID);
}

TEST_F(PosePublisherTest, ANewCalibrationForgetsTheOldOnesHand) {
  publisher_.use(calibration_);
  add_hand(0);
  add_hand(16);
  add_frame(4);
  calibration_.request_id = 78;  // of another body, perhaps
  publisher_.use(calibration_);
  EXPECT_TRUE(publish(20).empty());
  add_frame(20);
  add_hand(16);
  add_hand(32);
  ASSERT_EQ(publish(40).size(), 1U);
  EXPECT_EQ(heard_.front().calibration_request_id, 78);
  EXPECT_EQ(heard_.front().frame_seq, 20);
}

TEST_F(PosePublisherTest, PredictsWhenTheSampleAfterTheFrameDoesNotComeSoon) {
  publisher_.use(calibration_);
  for (std::int64_t at_ms = 0; at_ms <= 160; at_ms += 16) add_hand(at_ms);
  add_frame(180);
  EXPECT_TRUE(publish(199).empty()) << "the sample after it may come";
  EXPECT_EQ(publisher_.due_ns(camera_ns(199)), camera_ns(200));
  ASSERT_EQ(publish(200).size(), 1U);
  const camera_pose_t& pose = heard_.front();
  EXPECT_EQ(pose.validity, camera_pose_t::VALID);
  EXPECT_EQ(pose.flags, camera_pose_t::FLAG_PREDICTED);
  EXPECT_NEAR(pose.predicted_s, 0.020, 1e-12);
  const Pose expected =
      room_from_hand_at(kStart_ns + 180 * kMillisecond_ns) * calibration_.hand_from_eye;
  EXPECT_TRUE(pose_of(pose).isApprox(expected, 1e-6));
  EXPECT_FALSE(publisher_.due_ns(camera_ns(200)).has_value());
}

TEST_F(PosePublisherTest, TakesTheSampleThatComesWhileTheFrameWaits) {
  publisher_.use(calibration_);
  for (std::int64_t at_ms = 0; at_ms <= 160; at_ms += 16) add_hand(at_ms);
  add_frame(170);
  EXPECT_TRUE(publish(180).empty());
  add_hand(176);
  ASSERT_EQ(publish(189).size(), 1U);
  EXPECT_EQ(heard_.front().flags, 0);
  EXPECT_EQ(heard_.front().predicted_s, 0);
}

TEST_F(PosePublisherTest, DoesNotPredictTooFar) {
  publisher_.use(calibration_);
  for (std::int64_t at_ms = 0; at_ms <= 160; at_ms += 16) add_hand(at_ms);
  add_frame(221);
  EXPECT_TRUE(publish(300).empty());
  EXPECT_EQ(publisher_.due_ns(camera_ns(300)), camera_ns(421)) << "no busy waiting";
  ASSERT_EQ(publish(421).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_LATE);
  EXPECT_EQ(heard_.front().flags, 0);
}

TEST_F(PosePublisherTest, NeverPredictsFromAHiddenHand) {
  publisher_.use(calibration_);
  for (std::int64_t at_ms = 0; at_ms <= 160; at_ms += 16) add_hand(at_ms);
  add_hand(176, false);
  add_frame(180);
  EXPECT_TRUE(publish(260).empty());
  add_hand(192);
  ASSERT_EQ(publish(270).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_HIDDEN);
}

TEST_F(PosePublisherTest, WaitsWherePredictionIsOff) {
  PosePublisher publisher(bus_, kChannel, {.wait_ns = 0, .predict_ns = 0});
  publisher.use(calibration_);
  for (std::int64_t at_ms = 0; at_ms <= 160; at_ms += 16) {
    const std::int64_t tracker_ns = kStart_ns + at_ms * kMillisecond_ns;
    publisher.add_hand({tracker_ns, true, room_from_hand_at(tracker_ns)});
  }
  publisher.add_frame({camera_ns(170), 1, camera_ns(170)});
  EXPECT_EQ(publisher.due_ns(camera_ns(170)), camera_ns(370));
  publisher.publish_ready(camera_ns(369));
  EXPECT_TRUE(publish(0).empty());
  publisher.publish_ready(camera_ns(370));
  ASSERT_EQ(publish(0).size(), 1U);
  expect_invalid(heard_.front(), camera_pose_t::TRACKER_LATE);
}

TEST_F(PosePublisherTest, SaysWhetherTheCalibrationIsStillTrusted) {
  publisher_.use(calibration_);
  const auto flags_after = [&](const WatchWord& word, std::int64_t at_ms) {
    publisher_.hear(word);
    add_hand(at_ms);
    add_frame(at_ms);
    return publish(at_ms).back().flags;
  };
  EXPECT_EQ(flags_after({77, status_t::WATCH_HOLDS}, 0), 0);
  EXPECT_EQ(flags_after({77, status_t::WATCH_DOUBTFUL}, 16),
            camera_pose_t::FLAG_CALIBRATION_DOUBTFUL);
  EXPECT_EQ(flags_after({77, status_t::WATCH_BROKEN}, 32), camera_pose_t::FLAG_CALIBRATION_BROKEN);
  EXPECT_EQ(heard_.back().validity, camera_pose_t::VALID) << "it is still what calibration says";
  EXPECT_EQ(flags_after({76, status_t::WATCH_BROKEN}, 48), 0) << "of another calibration";
  // Told before the publisher knew of the calibration.
  publisher_.hear({78, status_t::WATCH_DOUBTFUL});
  calibration_.request_id = 78;
  publisher_.use(calibration_);
  EXPECT_EQ(flags_after({78, status_t::WATCH_DOUBTFUL}, 64),
            camera_pose_t::FLAG_CALIBRATION_DOUBTFUL);
}

}  // namespace
}  // namespace handeye
