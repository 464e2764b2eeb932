// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/sample_recording.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

class MaskFile : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "mask.png";
};

TEST_F(MaskFile, BecomesBlackAndWhite) {
  cv::Mat image(4, 6, CV_8UC3, cv::Scalar(20, 20, 20));
  image(cv::Rect(1, 1, 3, 2)).setTo(cv::Scalar(250, 250, 250));
  cv::imwrite(path_, image);
  const cv::Mat mask = read_mask(path_);
  ASSERT_EQ(mask.type(), CV_8UC1);
  ASSERT_EQ(mask.size(), cv::Size(6, 4));
  EXPECT_EQ(cv::countNonZero(mask), 6);
  EXPECT_EQ(cv::countNonZero(mask == 255), 6);
}

TEST_F(MaskFile, MustBeThereAndAnImage) {
  expect_input_error([&] { read_mask(path_); }, {"mask.png", "not there"});
  write_bytes(path_, "no image");
  expect_input_error([&] { read_mask(path_); }, {"mask.png", "no image"});
  write_bytes(path_, "");
  expect_input_error([&] { read_mask(path_); }, {"mask.png", "no image"});
}

TEST_F(MaskFile, MustNotBeAllBlack) {
  cv::imwrite(path_, cv::Mat::zeros(4, 6, CV_8UC1));
  expect_input_error([&] { read_mask(path_); }, {"mask.png", "all black"});
}

}  // namespace
}  // namespace handeye
