// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/unit/recording/sample_recording.hpp"

namespace handeye {
namespace {

std::filesystem::path data_folder() {
  const char* const given = std::getenv("HANDEYE_DATA");
  return given != nullptr ? given : std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data";
}

TEST(RealData, ChessboardFolderIsReadCompletely) {
  const std::filesystem::path path = data_folder() / "chessboard";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data: set HANDEYE_DATA";
  const Recording recording = open_recording(path);
  EXPECT_EQ(read_all_frames(path), 8);
  ASSERT_TRUE(recording.camera_model);
  EXPECT_EQ(recording.camera_model->width, 640);
  EXPECT_DOUBLE_EQ(recording.camera_model->fy, 607.5750);
  EXPECT_TRUE(recording.mask.empty());
  ASSERT_GT(recording.datagrams.size(), 100U);
  for (const RecordedDatagram& datagram : recording.datagrams) {
    EXPECT_TRUE(datagram.bytes.starts_with("fr "));
  }
}

TEST(RealData, SinusFolderIsReadCompletely) {
  const std::filesystem::path path = data_folder() / "sinus";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data: set HANDEYE_DATA";
  const Recording recording = open_recording(path);
  EXPECT_EQ(read_all_frames(path), 35);
  EXPECT_TRUE(recording.datagrams.empty());
  EXPECT_EQ(recording.mask.size(), cv::Size(1920, 1080));
}

}  // namespace
}  // namespace handeye
