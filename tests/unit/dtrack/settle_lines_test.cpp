// SPDX-License-Identifier: BSD-3-Clause
// What the lines of one datagram say together.
#include <gtest/gtest.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

const std::string kElsewhere = "[1.000 2.000 3.000]" + kMatrix;

TEST(DTrackSettle, OpticalPoseStandsAndInertialStateJoins) {
  const std::string optical = "6d 1 " + body("0");
  const std::string hybrid = "6di 2 [0 3 0.500]" + kElsewhere + " [4 1 2.000]" + kElsewhere;
  for (const Parsed& parsed : {Parsed{optical, hybrid}, Parsed{hybrid, optical}}) {
    ASSERT_EQ(parsed.frame.bodies.size(), 2U);
    const Body& both = *parsed.frame.find_body(0);
    EXPECT_EQ(both.room_from_body.translation().x(), 412.507);
    EXPECT_EQ(both.inertial_state, 3);
    EXPECT_DOUBLE_EQ(both.inertial_drift_rad, rad_from_deg(0.5));
    const Body& inertial = *parsed.frame.find_body(4);
    EXPECT_TRUE(inertial.tracked);
    EXPECT_EQ(inertial.room_from_body.translation().x(), 1.0);
  }
}

TEST(DTrackSettle, ABodyThatOnlyTheHybridLineFollowsTakesItsPose) {
  const Parsed parsed{"6d 1 [0 -1.000]" + kPositionAndAngles + kZeroMatrix,
                      "6di 1 [0 1 0.500]" + kElsewhere};
  ASSERT_EQ(parsed.frame.bodies.size(), 1U);
  EXPECT_TRUE(parsed.frame.bodies[0].tracked);
  EXPECT_EQ(parsed.frame.bodies[0].room_from_body.translation().x(), 1.0);
}

TEST(DTrackSettle, UntrackedBodyHasNoPose) {
  const Parsed parsed{"6d 1 [0 -1.000]" + kPositionAndAngles + kMatrix};
  ASSERT_EQ(parsed.frame.bodies.size(), 1U);
  EXPECT_FALSE(parsed.frame.bodies[0].tracked);
  EXPECT_TRUE(parsed.frame.bodies[0].room_from_body.matrix().isIdentity(0));
}

TEST(DTrackSettle, HybridStateAndRotationAreChecked) {
  const Parsed state{"6di 1 [0 4 0.000]" + kElsewhere};
  EXPECT_EQ(state.counters()[ErrorKind::kNumberOutOfRange], 1U);
  EXPECT_TRUE(state.frame.bodies.empty());
  const Parsed rotation{"6di 1 [0 2 0.000][1 2 3]" + kZeroMatrix};
  EXPECT_EQ(rotation.counters()[ErrorKind::kBadRotation], 1U);
  EXPECT_TRUE(rotation.frame.bodies.empty());
}

TEST(DTrackSettle, CovarianceOfARefusedBodyGoesWithIt) {
  const std::string covariance =
      "6dcov 1 [0 1.0 2.0 3.0][1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1]";
  EXPECT_TRUE(
      (Parsed{"6d 1 [0 1.000]" + kPositionAndAngles + kZeroMatrix, covariance}.frame.covariances)
          .empty());
  const Parsed short_matrix{"6d 1 " + body("0"), "6dcov 1 [0 1.0 2.0 3.0][1 0 0 0 0 0 1]"};
  EXPECT_EQ(short_matrix.counters()[ErrorKind::kMissingValue], 1U);
}

}  // namespace
}  // namespace handeye::dtrack
