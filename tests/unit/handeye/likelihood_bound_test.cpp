// SPDX-License-Identifier: BSD-3-Clause
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/handeye/cramer_rao.hpp"
#include "tests/unit/handeye/regimes.hpp"

namespace handeye {
namespace {

using synthetic::Regime;
using synthetic::RmsError;

constexpr int kSeeds = 200;
constexpr double kUnitsPerMm = 0.037;

std::vector<HandEyeObservation> observed(const std::vector<PosePair>& poses) {
  std::vector<HandEyeObservation> observations;
  for (const PosePair& pair : poses) observations.push_back({.poses = pair});
  return observations;
}

/// Root mean squares over the seeds, and those of the bound.
struct Figures {
  RmsError error;
  double bound_rotation_square{0};
  double bound_translation_square{0};

  double bound_rotation_deg() const {
    return deg_from_rad(std::sqrt(bound_rotation_square / kSeeds));
  }
  double bound_translation_mm() const { return std::sqrt(bound_translation_square / kSeeds); }

  void add(const std::optional<MaximumLikelihoodResult>& found, const synthetic::Truth& truth,
           const Matrix6d& bound) {
    ASSERT_TRUE(found);
    error.add(synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye));
    bound_rotation_square += bound.topLeftCorner<3, 3>().trace();
    bound_translation_square += bound.bottomRightCorner<3, 3>().trace();
  }

  void expect_near_bound(std::string_view regime, std::string_view what) const {
    fmt::print("{:<20} {:<32} {:.4f} deg = {:.3f} of the bound, {:.4f} mm = {:.3f}\n", regime, what,
               error.rotation_deg(), error.rotation_deg() / bound_rotation_deg(),
               error.translation_mm(), error.translation_mm() / bound_translation_mm());
    EXPECT_LT(error.rotation_deg(), 1.1 * bound_rotation_deg()) << what;
    EXPECT_LT(error.translation_mm(), 1.1 * bound_translation_mm()) << what;
  }
};

class LikelihoodBound : public testing::TestWithParam<std::size_t> {
 protected:
  const Regime& regime() const { return synthetic::regimes()[GetParam()]; }
};

/// With the noise given (from the truth: it is the minimum that is tested), and as users have it:
/// from any start, the noise estimated from any assumption. An unknown scale costs what it must.
TEST_P(LikelihoodBound, IsReached) {
  MaximumLikelihoodOptions given{
      .noise = regime().noise, .estimate_noise = false, .account_for_correlation = false};
  MaximumLikelihoodOptions estimated{.account_for_correlation = false};
  Figures known_given, known_estimated, unknown_given, unknown_estimated;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const auto known = synthetic::sample(regime(), seed, 1.0);
    const auto bound =
        synthetic::cramer_rao_bound(known.truth, known.room_from_hand, regime().noise);
    given.estimate_scale = estimated.estimate_scale = false;
    const auto known_poses = observed(known.poses);
    known_given.add(maximum_likelihood(known_poses, known.truth.solution, given), known.truth,
                    bound.known_scale);
    known_estimated.add(maximum_likelihood(known_poses, estimated), known.truth, bound.known_scale);

    const auto unknown = synthetic::sample(regime(), seed, kUnitsPerMm);
    given.estimate_scale = estimated.estimate_scale = true;
    const auto unknown_poses = observed(unknown.poses);
    unknown_given.add(maximum_likelihood(unknown_poses, unknown.truth.solution, given),
                      unknown.truth, bound.unknown_scale);
    unknown_estimated.add(maximum_likelihood(unknown_poses, estimated), unknown.truth,
                          bound.unknown_scale);
  }
  known_given.expect_near_bound(regime().name, "known scale, noise given");
  unknown_given.expect_near_bound(regime().name, "unknown scale, noise given");
  known_estimated.expect_near_bound(regime().name, "known scale, noise estimated");
  unknown_estimated.expect_near_bound(regime().name, "unknown scale, noise estimated");
  EXPECT_LT(unknown_estimated.error.rotation_deg(), 1.1 * known_estimated.error.rotation_deg());
  EXPECT_LT(unknown_estimated.error.translation_mm() / known_estimated.error.translation_mm(),
            1.15 * unknown_given.bound_translation_mm() / known_given.bound_translation_mm());
}

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  std::string name;
  for (const char c : synthetic::regimes()[info.param].name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Regimes, LikelihoodBound,
                         testing::Range<std::size_t>(0, synthetic::regimes().size()), name_of);

}  // namespace
}  // namespace handeye
