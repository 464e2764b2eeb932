// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/tracking/endoscope_disc.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace handeye::test {

cv::Mat truth_of(const Disc& disc) {
  cv::Mat truth = cv::Mat::zeros(disc.size, CV_8UC1);
  cv::circle(truth, disc.centre, disc.radius, 255, cv::FILLED);
  return truth;
}

cv::Mat tissue(cv::Size size) {
  cv::Mat image(size, CV_8UC1);
  cv::RNG random(5);
  random.fill(image, cv::RNG::UNIFORM, 60, 255);
  cv::GaussianBlur(image, image, {}, 0.02 * size.width);
  cv::normalize(image, image, 50, 210, cv::NORM_MINMAX);
  cv::circle(image, {size.width / 2, size.height / 3}, size.height / 10, 15, cv::FILLED);
  return image;
}

cv::Mat view(const Disc& disc, unsigned seed) {
  cv::Mat image(disc.size, CV_8UC1);
  cv::RNG random(seed);  // what a sensor shows of nothing
  random.fill(image, cv::RNG::NORMAL, 4, 2);
  tissue(disc.size).copyTo(image, truth_of(disc));
  return image;
}

Agreement compare(const cv::Mat& found, const cv::Mat& truth) {
  const double common = cv::countNonZero(found & truth);
  return {common / cv::countNonZero(found | truth), cv::countNonZero(found & ~truth)};
}

void expect_within(const cv::Mat& found, const cv::Mat& truth, double overlap) {
  ASSERT_EQ(found.size(), truth.size());
  const Agreement agreement = compare(found, truth);
  EXPECT_EQ(agreement.outside, 0);
  EXPECT_GT(agreement.overlap, overlap);
}

}  // namespace handeye::test
