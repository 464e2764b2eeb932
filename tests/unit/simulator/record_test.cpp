// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/record.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drivers/recording/recording.hpp"
#include "drivers/simulator/endoscope_device.hpp"
#include "drivers/simulator/tracker_device.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStartNs = 1'000'000'000'000;
constexpr double kDurationS = 0.8;

class RecordTest : public testing::Test {
 protected:
  RecordTest() { fs::create_directories(directory_); }
  ~RecordTest() override { fs::remove_all(directory_); }
  RecordTest(const RecordTest&) = delete;
  RecordTest& operator=(const RecordTest&) = delete;

  static SimulatorOptions options() {
    SimulatorOptions options;
    options.seed = 8;
    return options;
  }

  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  void expect_readable(const fs::path& path, const fs::path& truth_path) const;

  fs::path directory_{fs::temp_directory_path() /
                      fmt::format("handeye_record_test_{}", ::getpid())};
  World world_{options(), kStartNs};
};

void RecordTest::expect_readable(const fs::path& path, const fs::path& truth_path) const {
  const Recording recording = open_recording(path);
  ASSERT_TRUE(recording.camera_model.has_value());
  EXPECT_EQ(recording.camera_model->fx, world_.camera.fx);
  EXPECT_EQ(recording.camera_model->distortion, world_.camera.distortion);

  ASSERT_FALSE(recording.camera->open().has_value());
  EndoscopeDevice endoscope(world_);
  SimulatedFrame truth;
  Frame frame;
  std::uint32_t number = 0;
  while (recording.camera->grab(frame, std::chrono::milliseconds(1000)) == GrabStatus::kFrame) {
    endoscope.make(number++, truth);
    EXPECT_EQ(frame.timestamp_ns, truth.timestamp_ns);
    ASSERT_EQ(frame.grey.size(), truth.grey.size());
    EXPECT_LT(cv::norm(frame.grey, truth.grey, cv::NORM_L1),
              2.0 * static_cast<double>(truth.grey.total()));
  }
  EXPECT_EQ(number, 20U);

  TrackerDevice tracker(world_);
  SimulatedDatagram datagram;
  EXPECT_EQ(recording.datagrams.size(), 48U);
  for (const RecordedDatagram& recorded : recording.datagrams) {
    tracker.next(datagram);
    EXPECT_EQ(recorded.arrival_ns, datagram.arrival_ns);
    EXPECT_EQ(recorded.bytes, datagram.bytes);
  }
  const auto truth_json = nlohmann::json::parse(content(truth_path));
  EXPECT_EQ(truth_json.at("time_offset_s").get<double>(), world_.time_offset_s());
}

TEST_F(RecordTest, FolderIsReadBack) {
  const fs::path path = directory_ / "folder";
  const DeviceCounts counts = record(world_, kDurationS, path);
  EXPECT_EQ(counts.frames, 20U);
  EXPECT_EQ(counts.datagrams, 48U);
  expect_readable(path, path / "truth.json");
}

TEST_F(RecordTest, LogIsReadBack) {
  const fs::path path = directory_ / "log.lcm";
  record(world_, kDurationS, path);
  expect_readable(path, directory_ / "log.truth.json");
}

TEST_F(RecordTest, SameWorldSameBytes) {
  record(world_, kDurationS, directory_ / "one");
  record(World(options(), kStartNs), kDurationS, directory_ / "two");
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(directory_ / "one")) {
    if (!entry.is_regular_file()) continue;
    const fs::path relative = fs::relative(entry.path(), directory_ / "one");
    EXPECT_EQ(content(entry.path()), content(directory_ / "two" / relative)) << relative;
    ++files;
  }
  EXPECT_GE(files, 20U + 4U);
}

TEST_F(RecordTest, DoesNotOverwrite) {
  record(world_, kDurationS, directory_ / "once");
  const std::string before = content(directory_ / "once" / "tracker.txt");
  EXPECT_THROW(record(world_, kDurationS, directory_ / "once"), InputError);
  EXPECT_EQ(content(directory_ / "once" / "tracker.txt"), before);
}

TEST_F(RecordTest, SaysWhereItCannotWrite) {
  try {
    record(world_, kDurationS, directory_ / "no" / "such" / "folder.lcm");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("folder.lcm"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace handeye::simulator
