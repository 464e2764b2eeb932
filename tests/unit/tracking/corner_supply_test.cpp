// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/corner_supply.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

const cv::Size kSize(640, 480);

void add(const std::vector<Corner>& corners, TrackTable& tracks) {
  for (const Corner& corner : corners) {
    const Eigen::Vector2f pixel(static_cast<float>(corner.x), static_cast<float>(corner.y));
    tracks.add(static_cast<std::int64_t>(tracks.size()), pixel, corner.strength);
  }
}

TEST(CornerSupply, SearchesAllAtOnceAtTheStartAndAfterALoss) {
  const test::MovingTexture texture(kSize);
  ImagePyramid pyramid;
  pyramid.build(texture.image(0), {}, 0, 3);
  CornerSupply supply({});
  TrackTable tracks(300);
  add(supply.find(pyramid, 0, tracks), tracks);
  EXPECT_GT(tracks.size(), 250U);
  for (std::size_t row = 20; row < tracks.size(); ++row) tracks.lost[row] = 1;
  tracks.drop_lost();
  add(supply.find(pyramid, 0, tracks), tracks);
  EXPECT_GT(tracks.size(), 250U);
}

TEST(CornerSupply, SearchesABareSceneAPartAtATime) {
  const test::MovingTexture texture(kSize);
  // Texture in a fifth of the image only, then everywhere: what is new is found bit by bit.
  cv::Mat bare(kSize, CV_8UC1, cv::Scalar(100));
  const cv::Mat image = texture.image(0);
  const cv::Rect textured(0, 0, 280, 220);
  image(textured).copyTo(bare(textured));
  ImagePyramid pyramid;
  pyramid.build(bare, {}, 0, 3);
  CornerSupply supply({});
  TrackTable tracks(300);
  add(supply.find(pyramid, 0, tracks), tracks);
  for (int frame = 0; frame < 30; ++frame) add(supply.find(pyramid, 0, tracks), tracks);
  ASSERT_GT(tracks.size(), 40U);
  ASSERT_LT(tracks.size(), 150U);
  pyramid.build(image, {}, 0, 3);
  const std::size_t before = tracks.size();
  add(supply.find(pyramid, 0, tracks), tracks);
  EXPECT_GT(tracks.size(), before + 40);
  EXPECT_LT(tracks.size(), before + 200);
  for (int frame = 0; frame < 8; ++frame) add(supply.find(pyramid, 0, tracks), tracks);
  EXPECT_GT(tracks.size(), 250U);
}

}  // namespace
}  // namespace handeye
