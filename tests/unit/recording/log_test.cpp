// SPDX-License-Identifier: BSD-3-Clause
#include <functional>

#include <gtest/gtest.h>
#include <handeye/datagram_t.hpp>
#include <handeye/image_t.hpp>
#include <handeye/request_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/sample_recording.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

/// Writes logs event by event, as any LCM program could.
class LogTest : public testing::Test {
 protected:
  template <typename Message>
  void add(const std::string& channel, const Message& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    add_bytes(channel, bytes);
  }

  void add_bytes(const std::string& channel, std::vector<std::uint8_t>& bytes) {
    lcm::LogEvent event{};
    event.timestamp = ++events_;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    ASSERT_EQ(log_->writeEvent(&event), 0);
  }

  image_t image(std::int64_t timestamp_ns) const {
    image_t image{};
    image.timestamp_ns = timestamp_ns;
    image.width = sample_.width;
    image.height = sample_.height;
    image.pixel_format = image_t::JPEG;
    image.data = sample_.jpeg(0);
    image.size = static_cast<std::int32_t>(image.data.size());
    return image;
  }

  static datagram_t datagram(std::int64_t arrival_ns) {
    datagram_t datagram{};
    datagram.arrival_ns = arrival_ns;
    datagram.size = 3;
    datagram.data = {'f', 'r', ' '};
    return datagram;
  }

  /// Finishes the log and expects it to be refused.
  void expect_refused(const std::initializer_list<std::string>& words) {
    log_.reset();
    expect_input_error([&] { read_all_frames(path_); }, words);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.lcm";
  std::unique_ptr<lcm::LogFile> log_ = std::make_unique<lcm::LogFile>(path_, "w");
  SampleRecording sample_;
  std::int64_t events_{0};
};

TEST_F(LogTest, AcceptsAnyPrefixAndPassesOverOtherChannels) {
  add("ROOM7_REQUEST", request_t{});
  add("ROOM7_FRAME", image(5));
  add("ROOM7_PREVIEW", image(6));
  add("ROOM7_DATAGRAM", datagram(6));
  log_.reset();
  const Recording recording = open_recording(path_);
  EXPECT_EQ(recording.datagrams.size(), 1U);
  EXPECT_EQ(read_all_frames(path_), 1);
}

TEST_F(LogTest, ReadsUncompressedFrames) {
  image_t grey = image(5);
  grey.pixel_format = image_t::GREY8;
  grey.stride = grey.width + 8;
  grey.size = grey.stride * grey.height;
  grey.data.assign(static_cast<std::size_t>(grey.size), 123);
  add("FRAME", grey);
  log_.reset();
  const Recording recording = open_recording(path_);
  Frame frame;
  ASSERT_EQ(recording.camera->grab(frame, std::chrono::milliseconds(0)), GrabStatus::kFrame);
  EXPECT_EQ(cv::norm(frame.grey, cv::Mat(grey.height, grey.width, CV_8UC1, cv::Scalar(123)),
                     cv::NORM_INF),
            0);
}

TEST_F(LogTest, RefusesTwoRoomsInOneLog) {
  add("A_FRAME", image(5));
  add("B_FRAME", image(6));
  expect_refused({"a.lcm", "event 1", "B_FRAME", "A_FRAME"});
}

TEST_F(LogTest, RefusesOtherTypesOnItsChannels) {
  add("A_FRAME", request_t{});
  expect_refused({"event 0", "A_FRAME", "not an image_t"});
}

TEST_F(LogTest, RefusesDatagramsThatAreNone) {
  add("A_FRAME", image(5));
  std::vector<std::uint8_t> bytes(datagram(6).getEncodedSize());
  datagram(6).encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  for (std::size_t i = 40; i < 44; ++i) bytes[i] = 0xFF;  // its size: -1
  add_bytes("A_DATAGRAM", bytes);
  expect_refused({"event 1", "A_DATAGRAM", "not a datagram_t"});
}

TEST_F(LogTest, RefusesTimeStampsThatDoNotIncrease) {
  add("A_FRAME", image(5));
  add("A_FRAME", image(5));
  expect_refused({"event 1", "A_FRAME", "time stamp"});
}

TEST_F(LogTest, RefusesDatagramsThatGoBackInTime) {
  add("A_FRAME", image(5));
  add("A_DATAGRAM", datagram(7));
  add("A_DATAGRAM", datagram(6));
  expect_refused({"event 2", "A_DATAGRAM", "before"});
}

TEST_F(LogTest, RefusesChangingSizes) {
  add("A_FRAME", image(5));
  image_t other = image(6);
  other.width = 32;
  add("A_FRAME", other);
  expect_refused({"event 1", "32x48", "64x48"});
}

TEST_F(LogTest, RefusesFieldsOutOfRange) {
  image_t wrong = image(5);
  wrong.pixel_format = 9;
  add("A_FRAME", wrong);
  expect_refused({"event 0", "pixel_format"});
}

TEST_F(LogTest, RefusesDamagedImagesWhenTheyAreGrabbed) {
  add("A_FRAME", image(5));
  image_t damaged = image(6);
  damaged.data.resize(damaged.data.size() / 2);
  damaged.size = static_cast<std::int32_t>(damaged.data.size());
  add("A_FRAME", damaged);
  log_.reset();
  const Recording recording = open_recording(path_);
  Frame frame;
  ASSERT_EQ(recording.camera->grab(frame, std::chrono::milliseconds(0)), GrabStatus::kFrame);
  expect_input_error([&] { recording.camera->grab(frame, std::chrono::milliseconds(0)); },
                     {"a.lcm", "event 1", "damaged"});
}

TEST_F(LogTest, RefusesImagesOfAnotherSizeThanAnnounced) {
  image_t lying = image(5);
  lying.width = 63;
  add("A_FRAME", lying);
  expect_refused({"event 0", "damaged"});
}

TEST_F(LogTest, RefusesAnEmptyFile) {
  expect_refused({"a.lcm", "no camera images"});
}

class DamagedLog : public testing::Test {
 protected:
  DamagedLog() {
    SampleRecording().write(folder_ / "whole.lcm");
    bytes_ = read_bytes(folder_ / "whole.lcm");
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.lcm";
  std::string bytes_;
};

TEST_F(DamagedLog, IsRefusedWhereverAnEventIsCut) {
  // Where events begin: there, and only there, a shorter log is a whole one.
  std::vector<std::size_t> boundaries;
  const std::string sync = "\xED\xA1\xDA\x01";
  for (std::size_t at = 0; (at = bytes_.find(sync, at)) != std::string::npos; ++at) {
    boundaries.push_back(at);
  }
  ASSERT_EQ(boundaries.size(), 7U);
  for (std::size_t length = 1; length < bytes_.size(); length += 13) {
    if (std::find(boundaries.begin(), boundaries.end(), length) != boundaries.end()) continue;
    write_bytes(path_, bytes_.substr(0, length));
    expect_input_error([&] { open_recording(path_); }, {"a.lcm", "cut short", "byte"});
  }
}

TEST_F(DamagedLog, IsRefusedWhereNoEventBegins) {
  write_bytes(path_, bytes_ + std::string(100, 'x'));
  expect_input_error([&] { open_recording(path_); },
                     {"a.lcm", "damaged", "byte " + std::to_string(bytes_.size())});
}

TEST_F(DamagedLog, IsRefusedWhenItIsNoLog) {
  write_bytes(path_, std::string(1000, 'x'));
  expect_input_error([&] { open_recording(path_); }, {"a.lcm", "no LCM log"});
}

TEST_F(DamagedLog, IsRefusedWhenItIsNotThereOrAFolder) {
  expect_input_error([&] { open_recording(path_); }, {"a.lcm", "not there"});
  std::filesystem::create_directory(path_);
  expect_input_error([&] { open_recording(path_); }, {"a.lcm", "is a folder"});
}

TEST_F(DamagedLog, NeverCrashesWithAnyByteChanged) {
  for (std::size_t at = 0; at < bytes_.size(); at += 7) {
    std::string changed = bytes_;
    changed[at] = static_cast<char>(~changed[at]);
    write_bytes(path_, changed);
    try {
      EXPECT_LE(read_all_frames(path_), 4);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("a.lcm"));
    }
  }
}

}  // namespace
}  // namespace handeye
