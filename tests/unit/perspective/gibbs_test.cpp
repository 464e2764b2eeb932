// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/gibbs.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "daemon/geometry/pose.hpp"

namespace handeye {
namespace {

std::vector<Eigen::Quaterniond> awkward_rotations() {
  std::vector<Eigen::Quaterniond> rotations;
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                      Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, -2, 3)}) {
    for (const double angle_deg :
         {0.0, 1e-7, 30.0, 90.0, 120.0, 179.0, 179.9999999, 180.0, 181.0}) {
      rotations.emplace_back(Eigen::AngleAxisd(rad_from_deg(angle_deg), axis.normalized()));
    }
  }
  return rotations;
}

TEST(Gibbs, IsTheAxisTimesTheTangentOfHalfTheAngle) {
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitY()));
  EXPECT_LT((gibbs_from_rotation(quarter) - Eigen::Vector3d(0, std::tan(kPi / 4), 0)).norm(),
            1e-15);
}

TEST(Gibbs, RoundTrips) {
  for (const Eigen::Quaterniond& rotation : awkward_rotations()) {
    if (std::abs(rotation.w()) < 1e-6) continue;
    const Eigen::Quaterniond back = rotation_from_gibbs(gibbs_from_rotation(rotation));
    EXPECT_LT(back.angularDistance(rotation), 1e-14);
  }
}

TEST(BasedGibbs, StaysSmallForEveryRotation) {
  for (const Eigen::Quaterniond& rotation : awkward_rotations()) {
    const BasedGibbs gibbs(rotation);
    EXPECT_LE(gibbs.z.norm(), std::sqrt(3.0) + 1e-12);
    EXPECT_LT(gibbs.rotation().angularDistance(rotation), 1e-14);
  }
}

TEST(BasedGibbs, DerivativeAgreesWithDifferences) {
  for (const Eigen::Quaterniond& rotation : awkward_rotations()) {
    const BasedGibbs gibbs(rotation);
    for (int k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-6;
      BasedGibbs plus = gibbs;
      BasedGibbs minus = gibbs;
      plus.z(k) += kStep;
      minus.z(k) -= kStep;
      const Eigen::Matrix3d change =
          (plus.rotation() * minus.rotation().conjugate()).toRotationMatrix();
      const Eigen::Vector3d numeric = log_so3(change) / (2 * kStep);
      EXPECT_LT((gibbs.rotation_vector_by_z().col(k) - numeric).norm(), 1e-8);
    }
  }
}

}  // namespace
}  // namespace handeye
