// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/handeye/judge.hpp"
#include "tests/unit/handeye/cramer_rao.hpp"
#include "tests/unit/handeye/parted.hpp"
#include "tests/unit/handeye/regimes.hpp"

/// A reconstruction in several parts: as good as can be, honest, and never led by a wrong part.
namespace handeye {
namespace {

using synthetic::free_hand;
using synthetic::in_parts;
using synthetic::record;
using synthetic::RmsError;
using synthetic::scope;
using synthetic::tracker_and_camera;

const std::vector<std::size_t> kLengths{60, 90, 40};
const std::vector<double> kScales{1.0, 0.2, 7.0};

Vector6d error_of(const MaximumLikelihoodResult& found) {
  return synthetic::error_of(found.solution.hand_from_eye, scope().solution.hand_from_eye);
}

double nees(const MaximumLikelihoodResult& found) {
  const Vector6d error = error_of(found);
  return error.dot(found.covariance.ldlt().solve(error));
}

/// hand_from_eye is all that the parts share: what they say of it adds up, each scene and scale
/// eliminated.
Matrix6d bound_of_parts() {
  std::vector<Pose> hand;
  for (const auto& observation : record(scope(), free_hand, 190, {0, 0, 0, 0}, 0).observations) {
    hand.push_back(observation.poses.room_from_hand);
  }
  Matrix6d information = Matrix6d::Zero();
  auto begin = hand.begin();
  for (const std::size_t length : kLengths) {
    const auto end = begin + static_cast<std::ptrdiff_t>(length);
    information += synthetic::cramer_rao_bound(scope(), {begin, end}, tracker_and_camera())
                       .unknown_scale.inverse();
    begin = end;
  }
  return information.inverse();
}

TEST(PartsAccuracy, ReachesTheBoundAndSaysSo) {
  constexpr std::uint32_t kSeeds = 100;
  const MaximumLikelihoodOptions given{.noise = tracker_and_camera(), .estimate_noise = false};
  RmsError of_all, of_all_given, of_largest;
  double nees_of_all = 0;
  double nees_given = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const auto recording = record(scope(), free_hand, 190, tracker_and_camera(), seed);
    const auto parted = in_parts(recording.observations, scope(), kLengths, kScales, seed);
    const auto all = maximum_likelihood(parted.observations);
    const auto all_given = maximum_likelihood(parted.observations, given);
    const auto largest = maximum_likelihood(synthetic::only(parted.observations, 1));
    ASSERT_TRUE(all && all_given && largest);
    EXPECT_EQ(all->part, 1);
    of_all.add(error_of(*all));
    of_all_given.add(error_of(*all_given));
    of_largest.add(error_of(*largest));
    nees_of_all += nees(*all) / kSeeds;
    nees_given += nees(*all_given) / kSeeds;
  }
  const Matrix6d bound = bound_of_parts();
  const double bound_deg = sigma_rotation_deg(bound);
  const double bound_mm = sigma_translation_mm(bound);
  fmt::print(
      "three parts {:.4f} deg = {:.3f} of the bound, {:.4f} mm = {:.3f}; noise given {:.3f}, "
      "{:.3f}; the largest alone {:.4f} deg, {:.4f} mm; mean NEES {:.2f}, noise given {:.2f}\n",
      of_all.rotation_deg(), of_all.rotation_deg() / bound_deg, of_all.translation_mm(),
      of_all.translation_mm() / bound_mm, of_all_given.rotation_deg() / bound_deg,
      of_all_given.translation_mm() / bound_mm, of_largest.rotation_deg(),
      of_largest.translation_mm(), nees_of_all, nees_given);
  for (const RmsError& error : {of_all, of_all_given}) {
    EXPECT_LT(error.rotation_deg(), 1.1 * bound_deg);
    EXPECT_LT(error.translation_mm(), 1.1 * bound_mm);
    EXPECT_LT(error.rotation_deg(), 0.9 * of_largest.rotation_deg());
    EXPECT_LT(error.translation_mm(), 0.9 * of_largest.translation_mm());
  }
  const double band = 3.29 * std::sqrt(2.0 * 6 / kSeeds);  // passed once in a thousand
  EXPECT_NEAR(nees_given, 6, band);
  EXPECT_NEAR(nees_of_all, 6, band);
}

TEST(PartsAccuracy, OfOnePartMoreNoiseTakesItsWeight) {
  RmsError of_both, of_good;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    auto observations = record(scope(), free_hand, 200, tracker_and_camera(), seed).observations;
    PoseNoise shaky = tracker_and_camera();
    shaky.eye_rotation_rad *= 20;
    shaky.eye_translation_mm *= 20;
    const auto noisy = record(scope(), free_hand, 200, shaky, seed + 1000).observations;
    std::copy(noisy.begin() + 120, noisy.end(), observations.begin() + 120);
    const auto parted = in_parts(observations, scope(), {120, 80}, {0.2, 7.0}, seed);
    const auto both = maximum_likelihood(parted.observations);
    const auto good = maximum_likelihood(synthetic::only(parted.observations, 0));
    ASSERT_TRUE(both && good);
    EXPECT_LT(nees(*both), 27.9) << "once in 10 000, seed " << seed;
    of_both.add(error_of(*both));
    of_good.add(error_of(*good));
  }
  fmt::print("with a noisy part {:.4f} deg, {:.4f} mm; without {:.4f} deg, {:.4f} mm\n",
             of_both.rotation_deg(), of_both.translation_mm(), of_good.rotation_deg(),
             of_good.translation_mm());
  EXPECT_LT(of_both.rotation_deg(), 1.05 * of_good.rotation_deg());
  EXPECT_LT(of_both.translation_mm(), 1.05 * of_good.translation_mm());
}

/// The camera of one part turned in its clip: as a wrong reconstruction, right in itself.
struct Contradiction {
  MaximumLikelihoodResult result;
  Judgement judgement;
};

Contradiction solved_with_slip(const std::vector<std::size_t>& lengths, int part, double slip_deg,
                               std::uint32_t seed) {
  const auto recording = record(scope(), free_hand, 400, tracker_and_camera(), seed);
  auto parted = in_parts(recording.observations, scope(), lengths, {0.2, 7.0, 1.0}, seed);
  synthetic::slip(parted.observations, part, {0, 0, rad_from_deg(slip_deg)});
  const auto found = maximum_likelihood(parted.observations);
  EXPECT_TRUE(found);
  if (!found) return {};
  return {*found, judge(parted.observations, found)};
}

TEST(PartsAccuracy, LeavesOutASmallPartThatContradicts) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const auto [result, judgement] = solved_with_slip({240, 120, 40}, 2, 2.0, seed);
    EXPECT_EQ(result.parts.back().poses_used, 0u);
    EXPECT_GT(result.parts.back().disagreement_chi2, 60.0);
    EXPECT_EQ(judgement.problem, MotionProblem::kNone) << seed;
    EXPECT_LT(nees(result), 27.9) << "once in 10 000, seed " << seed;
  }
}

TEST(PartsAccuracy, RefusesWhereALargePartContradicts) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    for (const int part : {0, 1}) {
      EXPECT_EQ(solved_with_slip({220, 180}, part, 2.0, seed).judgement.problem,
                MotionProblem::kUncertain)
          << part << ", seed " << seed;
      EXPECT_EQ(solved_with_slip({250, 90}, part, 2.0, seed).judgement.problem,
                MotionProblem::kUncertain)
          << part << ", seed " << seed;
    }
  }
}

/// What is accepted is right, however little one part contradicts the other.
TEST(PartsAccuracy, NeverAcceptsWhatASmallContradictionSpoils) {
  for (const double slip_deg : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      const auto [result, judgement] = solved_with_slip({220, 180}, 1, slip_deg, seed);
      if (judgement.problem != MotionProblem::kNone) continue;
      const Vector6d error = error_of(result);
      EXPECT_LT(deg_from_rad(error.head<3>().norm()),
                3.5 * sigma_rotation_deg(judgement.covariance))
          << slip_deg << ", seed " << seed;
      EXPECT_LT(error.tail<3>().norm(), 3.5 * sigma_translation_mm(judgement.covariance))
          << slip_deg << ", seed " << seed;
    }
  }
}

Judgement judged(const std::vector<synthetic::Motion>& motions, std::uint32_t seed) {
  std::vector<HandEyeObservation> observations;
  for (std::size_t p = 0; p < motions.size(); ++p) {
    const auto part = static_cast<std::uint32_t>(p);
    const auto recording =
        record(scope(), motions[p], 150, tracker_and_camera(), seed + 100 * part);
    const auto parted =
        in_parts(recording.observations, scope(), {150}, {kScales[p]}, seed + 100 * part);
    for (HandEyeObservation observation : parted.observations) {
      observation.part = static_cast<int>(p);
      observations.push_back(observation);
    }
  }
  return judge(observations, maximum_likelihood(observations));
}

TEST(PartsAccuracy, JudgesTheMotionOfAllParts) {
  for (std::uint32_t seed = 0; seed < 2; ++seed) {
    EXPECT_EQ(judged({free_hand, free_hand}, seed).problem, MotionProblem::kNone) << seed;
    EXPECT_EQ(judged({synthetic::pivot, free_hand}, seed).problem, MotionProblem::kNone) << seed;
    EXPECT_EQ(judged({free_hand, synthetic::one_axis}, seed).problem, MotionProblem::kNone) << seed;
    EXPECT_EQ(judged({synthetic::pivot, synthetic::pivot}, seed).problem,
              MotionProblem::kFixedPoint)
        << seed;
    EXPECT_EQ(judged({synthetic::one_axis, synthetic::one_axis}, seed).problem,
              MotionProblem::kSingleAxis)
        << seed;
    EXPECT_EQ(
        judged({synthetic::about_camera_centre, synthetic::about_camera_centre}, seed).problem,
        MotionProblem::kNoParallax)
        << seed;
    EXPECT_EQ(judged({synthetic::translation_only, synthetic::still}, seed).problem,
              MotionProblem::kInsufficientRotation)
        << seed;
  }
}

}  // namespace
}  // namespace handeye
