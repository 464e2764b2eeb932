// SPDX-License-Identifier: BSD-3-Clause
// What a stream of images makes of the field of view.
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/tracking/field_of_view.hpp"
#include "tests/unit/tracking/endoscope_disc.hpp"

namespace handeye {
namespace {

using test::Disc;
using test::expect_within;
using test::tissue;
using test::truth_of;
using test::view;

const Disc kDisc{{640, 480}, {330, 235}, 205};

TEST(FieldOfView, FillsInAsTheSceneMoves) {
  // A cavity wanders along the rim; after a while every part of the disc was lit.
  const cv::Mat truth = truth_of(kDisc);
  FieldOfView field;
  for (int frame = 0; frame < 60; ++frame) {
    cv::Mat image = view(kDisc, static_cast<unsigned>(frame));
    cv::Mat cavity = cv::Mat::zeros(kDisc.size, CV_8UC1);
    const double angle = 0.2 * frame;
    cv::circle(
        cavity,
        kDisc.centre + cv::Point(cvRound(170 * std::cos(angle)), cvRound(170 * std::sin(angle))),
        80, 255, cv::FILLED);
    image.setTo(6, cavity & truth);
    field.look(image);
  }
  expect_within(field.mask(), truth, 0.88);
}

TEST(FieldOfView, OutlivesDarkImagesAndFlares) {
  const cv::Mat truth = truth_of(kDisc);
  FieldOfView field;
  EXPECT_TRUE(field.look(cv::Mat::zeros(kDisc.size, CV_8UC1)).empty());
  EXPECT_TRUE(field.look(view(kDisc) * 0.1).empty());
  cv::Mat flare = view(kDisc);
  flare += 90;  // beyond the rim too
  field.look(flare);
  for (int frame = 0; frame < 40; ++frame) field.look(view(kDisc, static_cast<unsigned>(frame)));
  expect_within(field.mask(), truth, 0.88);
  const cv::Mat before = field.mask().clone();
  for (int frame = 0; frame < 200; ++frame) {
    field.look(frame % 50 == 7 ? flare : cv::Mat::zeros(kDisc.size, CV_8UC1));
  }
  EXPECT_EQ(cv::norm(before, field.mask(), cv::NORM_INF), 0);
}

TEST(FieldOfView, StaysTheSameWhileTheSceneChanges) {
  FieldOfView field;
  field.look(view(kDisc));
  const auto* memory = field.mask().data;
  ASSERT_NE(memory, nullptr);
  for (int frame = 1; frame < 50; ++frame) {
    cv::Mat image = view(kDisc, static_cast<unsigned>(frame));
    image.setTo(6, (tissue(kDisc.size) > 150 - frame % 40) & truth_of(kDisc));
    EXPECT_EQ(field.look(image).data, memory) << frame;
  }
}

TEST(FieldOfView, IsGivenUpWhereItWasNone) {
  // A bright plate on a black table, seen by an ordinary camera that then goes nearer.
  const cv::Size size(640, 480);
  FieldOfView field;
  EXPECT_FALSE(field.look(view({size, {320, 240}, 180})).empty());
  for (int frame = 0; frame < 60; ++frame) field.look(tissue(size));
  EXPECT_TRUE(field.mask().empty());
}

TEST(FieldOfView, IsWhatWasGiven) {
  const cv::Mat given = truth_of({{640, 480}, {100, 100}, 50});
  FieldOfView field(given);
  EXPECT_EQ(field.look(view(kDisc)).data, given.data);
}

/// How many images at 25 Hz it takes until the field of `next` is found.
int images_until_found(FieldOfView& field, const Disc& next) {
  const cv::Mat truth = truth_of(next);
  const cv::Mat image = view(next);
  for (int frame = 0; frame < 3000; ++frame) {
    const cv::Mat& found = field.look(image);
    if (found.empty()) continue;
    const test::Agreement agreement = test::compare(found, truth);
    if (agreement.outside == 0 && agreement.overlap > 0.88) return frame;
  }
  return 3000;
}

TEST(FieldOfView, ChangesWithTheScopeWithinAMinute) {
  const Disc wide{kDisc.size, {330, 235}, 230};
  const Disc narrow{kDisc.size, {330, 235}, 150};
  FieldOfView field;
  const cv::Mat image = view(wide);
  for (int frame = 0; frame < 2000; ++frame) field.look(image);
  expect_within(field.mask(), truth_of(wide), 0.88);
  EXPECT_LT(images_until_found(field, narrow), 25 * 60);
  EXPECT_LT(images_until_found(field, wide), 25 * 10);
}

}  // namespace
}  // namespace handeye
