// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/image_health.hpp"

#include <gtest/gtest.h>

#include "daemon/session/guidance.hpp"

namespace handeye {
namespace {

void add(ImageHealth& health, ImageCondition condition, int times) {
  for (int k = 0; k < times; ++k) health.add(condition);
}

TEST(ImageHealth, SaysWhatAilsNow) {
  ImageHealth health;
  EXPECT_EQ(health.recent(), ImageCondition::kGood);
  add(health, ImageCondition::kDark, 1);
  EXPECT_EQ(health.recent(), ImageCondition::kGood) << "one image is an accident";
  add(health, ImageCondition::kDark, 30);
  EXPECT_EQ(health.recent(), ImageCondition::kDark);
  add(health, ImageCondition::kGood, 16);
  EXPECT_EQ(health.recent(), ImageCondition::kGood);
  add(health, ImageCondition::kInterlaced, 30);
  EXPECT_EQ(health.recent(), ImageCondition::kGood);
  EXPECT_EQ(health.count(ImageCondition::kDark), 31);
  EXPECT_EQ(health.count(ImageCondition::kInterlaced), 30);
}

TEST(ImageHealth, DoesNotMindAGrabberThatIsFasterThanTheCamera) {
  for (const int shown_times : {2, 3, 4, 12}) {
    ImageHealth health;
    for (int k = 0; k < 240; ++k) {
      health.add(k % shown_times == 0 ? ImageCondition::kGood : ImageCondition::kFrozen);
      EXPECT_EQ(health.recent(), ImageCondition::kGood);
    }
    EXPECT_EQ(health.prevailing(), ImageCondition::kGood) << shown_times;
  }
}

TEST(ImageHealth, TellsAPictureThatSticksAgainAndAgain) {
  ImageHealth health;
  for (int k = 0; k < 200; ++k) {
    health.add(k % 40 < 10 ? ImageCondition::kGood : ImageCondition::kFrozen);
    EXPECT_EQ(health.recent() == ImageCondition::kFrozen, k % 40 >= 21) << k;
  }
  EXPECT_EQ(health.prevailing(), ImageCondition::kFrozen);
}

TEST(ImageHealth, BlamesWhatMostImagesWere) {
  ImageHealth health;
  EXPECT_EQ(health.prevailing(), ImageCondition::kGood);
  add(health, ImageCondition::kGood, 30);
  add(health, ImageCondition::kFrozen, 40);
  EXPECT_EQ(health.prevailing(), ImageCondition::kGood);
  add(health, ImageCondition::kFrozen, 10);
  EXPECT_EQ(health.prevailing(), ImageCondition::kFrozen);
  add(health, ImageCondition::kDark, 60);
  EXPECT_EQ(health.prevailing(), ImageCondition::kDark);
  add(health, ImageCondition::kUnusable, 70);
  EXPECT_EQ(health.prevailing(), ImageCondition::kUnusable);
  EXPECT_EQ(health.recent(), ImageCondition::kUnusable);
}

TEST(Guidance, SaysWhatAilsThePictureBeforeWhatIsInIt) {
  Situation situation;
  situation.any_frame = true;
  situation.features_recent = 200;
  const auto said = [&](ImageCondition condition) {
    situation.images = condition;
    return guidance_for(situation);
  };
  EXPECT_NE(said(ImageCondition::kDark).words.find("too dark"), std::string::npos);
  EXPECT_NE(said(ImageCondition::kFrozen).words.find("frozen"), std::string::npos);
  EXPECT_NE(said(ImageCondition::kBright).words.find("too bright"), std::string::npos);
  EXPECT_NE(said(ImageCondition::kUnusable).words.find("cannot be used"), std::string::npos);
  EXPECT_NE(said(ImageCondition::kBlurred).words.find("slower"), std::string::npos);
  EXPECT_NE(said(ImageCondition::kGood).words.find("tilt"), std::string::npos);
  situation.hand_hidden = true;
  EXPECT_NE(said(ImageCondition::kDark).words.find("hidden"), std::string::npos);
}

}  // namespace
}  // namespace handeye
