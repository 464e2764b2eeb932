// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/guidance.hpp"

#include <random>

#include <gmock/gmock.h>

#include "daemon/session/steady_guidance.hpp"

namespace handeye {
namespace {

using testing::HasSubstr;

/// All is as it should be, and the scope has moved enough by its path.
Situation good_situation() {
  Situation situation;
  situation.any_frame = true;
  situation.features_recent = 200;
  situation.state = ReconstructionState::kTracking;
  situation.rotation_coverage_deg = 30;
  situation.second_axis_deg = 8;
  situation.translation_coverage_mm = 30;
  return situation;
}

TEST(Guidance, NamesTheFirstThingThatIsMissing) {
  Situation situation;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kNoImage);
  situation.any_frame = true;
  situation.hand_hidden = true;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kHandHidden);
  EXPECT_THAT(guidance_for(situation).words, HasSubstr("hidden"));
  situation.hand_hidden = false;
  situation.images = ImageCondition::kDark;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kTooDark);
  situation.images = ImageCondition::kBlurred;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kSlower);
  situation.images = ImageCondition::kGood;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kLittleToSee);
  situation.features_recent = 200;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kTiltUpAndDown);
  situation.rotation_coverage_deg = 30;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kTurnLeftAndRight);
  situation.second_axis_deg = 8;
  EXPECT_EQ(guidance_for(situation).code, GuideCode::kSlideSideways);
  situation.translation_coverage_mm = 30;
  situation.state = ReconstructionState::kTracking;
  EXPECT_EQ(guidance_for(situation), Guidance{});
}

TEST(Guidance, OfAnAnswerGoesByItsInformationNotByThePath) {
  Provisional so_far;
  EXPECT_EQ(guidance_for(good_situation(), so_far).code, GuideCode::kNone) << "no answer yet";
  so_far.missing = MissingMotion::kRoll;
  EXPECT_EQ(guidance_for(good_situation(), so_far).code, GuideCode::kRoll);
  EXPECT_THAT(guidance_for(good_situation(), so_far).words, HasSubstr("roll"));
  so_far.missing = MissingMotion::kNone;
  Situation little_moved = good_situation();
  little_moved.rotation_coverage_deg = 15;
  EXPECT_EQ(guidance_for(little_moved, so_far).code, GuideCode::kNone) << "the answer is enough";
}

TEST(Guidance, PutsDevicesBeforeMotion) {
  Provisional so_far;
  so_far.missing = MissingMotion::kSlideInAndOut;
  Situation situation = good_situation();
  situation.hand_hidden = true;
  EXPECT_EQ(guidance_for(situation, so_far).code, GuideCode::kHandHidden);
  situation.hand_hidden = false;
  situation.images = ImageCondition::kFrozen;
  EXPECT_EQ(guidance_for(situation, so_far).code, GuideCode::kFrozen);
}

TEST(Guidance, HasWordsForEveryCode) {
  for (const MissingMotion missing :
       {MissingMotion::kTiltUpAndDown, MissingMotion::kTurnLeftAndRight, MissingMotion::kRoll,
        MissingMotion::kSlideInAndOut, MissingMotion::kSlideSideways, MissingMotion::kKeepMoving}) {
    Provisional so_far;
    so_far.missing = missing;
    const Guidance guidance = guidance_for(good_situation(), so_far);
    EXPECT_NE(guidance.code, GuideCode::kNone);
    EXPECT_EQ(guidance.words, words(missing));
  }
}

TEST(SteadyGuidance, ShowsWhatHasSettledAndKeepsIt) {
  SteadyGuidance steady;
  const Guidance no_image{GuideCode::kNoImage, "no image"};
  const Guidance tilt{GuideCode::kTiltUpAndDown, "tilt"};
  const Guidance roll{GuideCode::kRoll, "roll"};
  EXPECT_EQ(steady.show(no_image, 10), Guidance{}) << "it may be over in a moment";
  EXPECT_EQ(steady.show(tilt, 10.1), Guidance{});
  EXPECT_EQ(steady.show(tilt, 10.6), tilt);
  EXPECT_EQ(steady.show(roll, 11), tilt) << "not shown for long enough";
  EXPECT_EQ(steady.show(roll, 12.5), tilt);
  EXPECT_EQ(steady.show(tilt, 12.55), tilt);
  EXPECT_EQ(steady.show(roll, 12.7), tilt) << "due for the first time";
  EXPECT_EQ(steady.show(roll, 13.2), roll);
}

TEST(SteadyGuidance, FollowsOtherWordsOfTheSameThing) {
  SteadyGuidance steady;
  steady.show({GuideCode::kShowBoard, "show the board"}, 0);
  steady.show({GuideCode::kShowBoard, "show the board"}, 0.5);
  EXPECT_EQ(steady.show({GuideCode::kShowBoard, "board not in view"}, 0.6).words,
            "board not in view");
}

TEST(SteadyGuidance, NeverChangesTwiceInTwoSecondsAndNeverSticks) {
  std::mt19937 random(7);
  SteadyGuidance steady;
  constexpr double kStep_s = 0.1;
  GuideCode shown = GuideCode::kNone;
  double changed_s = -100;
  for (int i = 0; i < 5000; ++i) {
    const double time_s = i * kStep_s;
    const auto code = static_cast<GuideCode>(random() % 3 + 11);
    const GuideCode now = steady.show({code, "do it"}, time_s).code;
    if (now != shown) {
      EXPECT_GE(time_s - changed_s, 2.0 - 1e-9);
      changed_s = time_s;
    }
    shown = now;
  }
  for (int i = 0; i < 30; ++i) steady.show({GuideCode::kHandHidden, "hidden"}, 500 + i * kStep_s);
  EXPECT_EQ(steady.show({GuideCode::kHandHidden, "hidden"}, 503).code, GuideCode::kHandHidden);
}

}  // namespace
}  // namespace handeye
