// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "drivers/recording/log_writer.hpp"
#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/sample_recording.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

constexpr std::chrono::milliseconds kNoWait(0);

/// Both kinds of recording: what is written is read again.
class RoundTrip : public testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / GetParam();
  SampleRecording sample_;
  bool is_log() const { return path_.extension() == ".lcm"; }
};

TEST_P(RoundTrip, GivesFramesInOrderThenTheEnd) {
  sample_.write(path_);
  const Recording recording = open_recording(path_);
  Frame frame;
  for (std::size_t i = 0; i < sample_.timestamps_ns.size(); ++i) {
    ASSERT_EQ(recording.camera->grab(frame, kNoWait), GrabStatus::kFrame);
    EXPECT_EQ(frame.timestamp_ns, sample_.timestamps_ns[i]);
    EXPECT_EQ(frame.sequence, is_log() ? sample_.sequences[i] : i);
    ASSERT_EQ(frame.grey.size(), cv::Size(sample_.width, sample_.height));
    EXPECT_LT(cv::norm(frame.grey, sample_.image(i), cv::NORM_INF), 12);
  }
  EXPECT_EQ(recording.camera->grab(frame, kNoWait), GrabStatus::kEnd);
  EXPECT_EQ(recording.camera->grab(frame, kNoWait), GrabStatus::kEnd);
  EXPECT_EQ(recording.camera->counters().received, 4U);
  EXPECT_EQ(recording.camera->counters().dropped, is_log() ? 1U : 0U);
}

TEST_P(RoundTrip, StartsAgainWhenOpened) {
  sample_.write(path_);
  const Recording recording = open_recording(path_);
  Frame frame;
  while (recording.camera->grab(frame, kNoWait) == GrabStatus::kFrame) {
  }
  recording.camera->close();
  ASSERT_EQ(recording.camera->open(), std::nullopt);
  ASSERT_EQ(recording.camera->grab(frame, kNoWait), GrabStatus::kFrame);
  EXPECT_EQ(frame.timestamp_ns, sample_.timestamps_ns.front());
  EXPECT_EQ(recording.camera->counters().opened, 1U);
}

TEST_P(RoundTrip, GivesEveryDatagramUntouched) {
  sample_.write(path_);
  const Recording recording = open_recording(path_);
  ASSERT_EQ(recording.datagrams.size(), sample_.datagrams.size());
  for (std::size_t i = 0; i < sample_.datagrams.size(); ++i) {
    EXPECT_EQ(recording.datagrams[i].arrival_ns, sample_.datagrams[i].arrival_ns);
    EXPECT_EQ(recording.datagrams[i].bytes, sample_.datagrams[i].bytes);
  }
}

TEST_P(RoundTrip, GivesTheCameraModelBitForBit) {
  sample_.camera->fx = 1.0 / 3.0 * 1000;
  sample_.write(path_);
  const Recording recording = open_recording(path_);
  ASSERT_TRUE(recording.camera_model);
  EXPECT_EQ(recording.camera_model->width, sample_.camera->width);
  EXPECT_EQ(recording.camera_model->height, sample_.camera->height);
  EXPECT_EQ(recording.camera_model->fx, sample_.camera->fx);
  EXPECT_EQ(recording.camera_model->fy, sample_.camera->fy);
  EXPECT_EQ(recording.camera_model->cx, sample_.camera->cx);
  EXPECT_EQ(recording.camera_model->cy, sample_.camera->cy);
  EXPECT_EQ(recording.camera_model->distortion, sample_.camera->distortion);
}

TEST_P(RoundTrip, NeedsNoTrackerCameraOrMask) {
  sample_.datagrams.clear();
  sample_.camera.reset();
  sample_.write(path_);
  const Recording recording = open_recording(path_);
  EXPECT_TRUE(recording.datagrams.empty());
  EXPECT_FALSE(recording.camera_model);
  EXPECT_TRUE(recording.mask.empty());
}

TEST_P(RoundTrip, FindsTheMask) {
  sample_.write(path_);
  cv::Mat mask(sample_.height, sample_.width, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(8, 8, 16, 16)) = 255;
  cv::imwrite(is_log() ? folder_ / "recording.mask.png" : path_ / "mask.png", mask);
  const Recording recording = open_recording(path_);
  ASSERT_EQ(recording.mask.size(), mask.size());
  EXPECT_EQ(cv::norm(recording.mask, mask, cv::NORM_INF), 0);
}

TEST_P(RoundTrip, DescribesItself) {
  sample_.write(path_);
  EXPECT_EQ(open_recording(path_).camera->description(),
            "recording " + path_.string() + " 64x48 18.8 Hz, 4 frames");
}

TEST_P(RoundTrip, RefusesToOverwrite) {
  sample_.write(path_);
  expect_input_error([&] { create_recording(path_, std::nullopt); },
                     {path_.string(), "not overwritten"});
  EXPECT_EQ(read_all_frames(path_), 4) << "the first recording must be unharmed";
}

TEST_P(RoundTrip, RefusesAFolderThatCannotBeWritten) {
  write_bytes(folder_ / "file", "");
  const std::filesystem::path impossible = folder_ / "file" / GetParam();
  expect_input_error([&] { create_recording(impossible, std::nullopt); }, {impossible.string()});
}

TEST_P(RoundTrip, RefusesARecordingWithoutFrames) {
  const auto writer = create_recording(path_, sample_.camera);
  writer->write_datagram(1, "fr 1\r\n");
  writer->close();
  expect_input_error([&] { open_recording(path_); }, {path_.string(), "image"});
}

INSTANTIATE_TEST_SUITE_P(Kinds, RoundTrip, testing::Values("recording.lcm", "recording"),
                         [](const auto& test) {
                           return std::string(test.param).ends_with(".lcm") ? "Log" : "Folder";
                         });

TEST(LogWriter, WritesTheSameBytesForTheSameInput) {
  const TemporaryFolder folder;
  SampleRecording().write(folder / "a.lcm");
  SampleRecording().write(folder / "b.lcm");
  EXPECT_EQ(read_bytes(folder / "a.lcm"), read_bytes(folder / "b.lcm"));
}

TEST(LogWriter, WritesWhatLcmItselfReads) {
  const TemporaryFolder folder;
  constexpr std::int64_t kRealtimeMinusMonotonicNs = 1'700'000'000'000'000'000;
  const auto writer = create_recording(folder / "a.lcm", std::nullopt, kRealtimeMinusMonotonicNs);
  const SampleRecording sample;
  writer->write_datagram(2'000'000, "fr 1\r\n");
  writer->write_frame(1'000'000, 3'000'000, 5, sample.width, sample.height, sample.jpeg(0));
  writer->close();

  lcm::LogFile log(folder / "a.lcm", "r");
  ASSERT_TRUE(log.good());
  const lcm::LogEvent* event = log.readNextEvent();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->channel, "HANDEYE_DATAGRAM");
  EXPECT_EQ(event->timestamp, 1'700'000'000'002'000);
  event = log.readNextEvent();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->channel, "HANDEYE_FRAME");
  EXPECT_EQ(event->timestamp, 1'700'000'000'003'000);
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST(LogWriter, SaysWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "a.lcm");
  LogWriter writer(folder / "a.lcm", 0);
  const auto write_and_close = [&] {
    writer.write_datagram(1, "fr 1\r\n");
    writer.close();
  };
  expect_input_error(write_and_close, {"a.lcm", "disk full"});
}

}  // namespace
}  // namespace handeye
