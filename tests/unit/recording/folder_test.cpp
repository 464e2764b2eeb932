// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/sample_recording.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

class FolderTest : public testing::Test {
 protected:
  FolderTest() { SampleRecording().write(path_); }

  void expect_refused(const std::initializer_list<std::string>& words) {
    expect_input_error([&] { read_all_frames(path_); }, words);
  }
  void write_table(const std::string& text) { write_bytes(path_ / "frames.csv", text); }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "recording";
};

TEST_F(FolderTest, ReadsTablesWithWindowsLineEnds) {
  write_table("timestamp_ns,file\r\n5,frames/000000.jpg\r\n6,frames/000001.jpg\r\n");
  EXPECT_EQ(read_all_frames(path_), 2);
}

TEST_F(FolderTest, TurnsColourImagesOfAnyFormatGrey) {
  cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(200, 100, 50));
  cv::imwrite(path_ / "frames/colour.png", colour);
  cv::imwrite(path_ / "frames/colour.jpg", colour);
  write_table("timestamp_ns,file\n5,frames/colour.png\n6,frames/colour.jpg\n");
  const Recording recording = open_recording(path_);
  constexpr double kLuminance = 0.114 * 200 + 0.587 * 100 + 0.299 * 50;
  Frame frame;
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(recording.camera->grab(frame, std::chrono::milliseconds(0)), GrabStatus::kFrame);
    ASSERT_EQ(frame.grey.type(), CV_8UC1);
    EXPECT_NEAR(cv::mean(frame.grey)[0], kLuminance, 1.5);
  }
}

TEST_F(FolderTest, RefusesAWrongHeader) {
  write_table("time,file\n5,frames/000000.jpg\n");
  expect_refused({"frames.csv", "line 1", "timestamp_ns,file"});
}

TEST_F(FolderTest, RefusesAnEmptyTable) {
  write_table("");
  expect_refused({"frames.csv", "line 1"});
  write_table("timestamp_ns,file\n");
  expect_refused({"frames.csv", "no image"});
}

TEST_F(FolderTest, RefusesRowsThatAreNone) {
  for (const std::string row : {"5", "x,frames/000000.jpg", "5.5,frames/000000.jpg",
                                "-5,frames/000000.jpg", "99999999999999999999,frames/000000.jpg",
                                "5,", "5,/frames/000000.jpg", " 5,frames/000000.jpg", ""}) {
    write_table("timestamp_ns,file\n" + row + "\n");
    expect_refused({"frames.csv", "line 2"});
  }
}

TEST_F(FolderTest, RefusesTimeStampsThatDoNotIncrease) {
  write_table("timestamp_ns,file\n5,frames/000000.jpg\n5,frames/000001.jpg\n");
  expect_refused({"frames.csv", "line 3", "time stamp"});
}

TEST_F(FolderTest, RefusesAMissingImageOnOpening) {
  std::filesystem::remove(path_ / "frames/000002.jpg");
  expect_input_error([&] { open_recording(path_); },
                     {"frames.csv", "line 4", "frames/000002.jpg", "not there"});
}

TEST_F(FolderTest, RefusesAnImageCutShort) {
  const std::string jpeg = read_bytes(path_ / "frames/000001.jpg");
  write_bytes(path_ / "frames/000001.jpg", jpeg.substr(0, jpeg.size() / 2));
  expect_refused({"frames/000001.jpg", "damaged"});
  write_bytes(path_ / "frames/000001.jpg", "");
  expect_refused({"frames/000001.jpg", "damaged"});
}

TEST_F(FolderTest, RefusesAPngCutShort) {
  cv::imwrite(path_ / "frames/x.png", SampleRecording().image(0));
  const std::string png = read_bytes(path_ / "frames/x.png");
  write_bytes(path_ / "frames/x.png", png.substr(0, png.size() / 2));
  write_table("timestamp_ns,file\n5,frames/x.png\n");
  expect_refused({"frames/x.png", "damaged"});
}

TEST_F(FolderTest, RefusesImagesThatAreNone) {
  write_bytes(path_ / "frames/000000.jpg", "this is no image");
  expect_input_error([&] { open_recording(path_); }, {"frames/000000.jpg", "no image"});
}

/// The image before must not be handed out once more in its place.
TEST_F(FolderTest, RefusesALaterImageThatIsNone) {
  write_bytes(path_ / "frames/000002.jpg", "this is no image");
  expect_refused({"frames/000002.jpg", "no image"});
}

TEST_F(FolderTest, RefusesChangingSizes) {
  cv::imwrite(path_ / "frames/000001.jpg", cv::Mat(32, 32, CV_8UC1, cv::Scalar(9)));
  expect_refused({"frames/000001.jpg", "32x32", "64x48"});
}

TEST_F(FolderTest, RefusesWhatIsNoRecording) {
  expect_input_error([&] { open_recording(folder_ / "nowhere"); }, {"nowhere", "not there"});
  expect_input_error([&] { open_recording(path_ / "frames.csv"); }, {"frames.csv", "no recording"});
  expect_input_error([&] { open_recording(path_ / "frames"); }, {"frames.csv", "not there"});
}

}  // namespace
}  // namespace handeye
