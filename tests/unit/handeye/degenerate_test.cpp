// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/handeye/synthetic.hpp"
#include "tests/unit/handeye/tables.hpp"

/// Input that does not determine hand-eye: every row of both tables says nothing.
namespace handeye {
namespace {

using synthetic::all_movements;
using synthetic::Truth;
using tables::expect_near;
using tables::kModes;
using tables::label;
using tables::movement_methods;
using tables::scale_in;

/// Every solver must say nothing rather than anything.
void expect_nothing(ScaleMode mode, const std::vector<PosePair>& poses,
                    const std::vector<Movement>& movements, const std::string& what) {
  for (const Method& method : methods(mode)) {
    EXPECT_FALSE(method.solve({.poses = poses, .movements = movements}))
        << label(method, mode) << ": " << what;
  }
}

void expect_nothing(ScaleMode mode, const std::vector<PosePair>& poses, const std::string& what) {
  expect_nothing(mode, poses, all_movements(poses), what);
}

std::vector<PosePair> exact_poses(ScaleMode mode, const synthetic::Motion& motion) {
  return synthetic::record(synthetic::scope(scale_in(mode, 0.1)), motion, 40, {0, 0, 0, 0}, 5)
      .poses();
}

TEST(Degenerate, MethodsGiveNothingOnDegenerateMotion) {
  for (const ScaleMode mode : kModes) {
    expect_nothing(mode, {}, "no pose");
    const std::vector<PosePair> good = exact_poses(mode, synthetic::free_hand);
    expect_nothing(mode, {good.front()}, "one pose");
    expect_nothing(mode, {good[0], good[20]}, "one movement");
    expect_nothing(mode, std::vector<PosePair>(10, good.front()), "identical poses");
    expect_nothing(mode, exact_poses(mode, synthetic::still), "still");
    expect_nothing(mode, exact_poses(mode, synthetic::translation_only), "pure translation");
    expect_nothing(mode, exact_poses(mode, synthetic::one_axis), "parallel axes");
  }
}

/// As a frozen image, or a tracker that repeats its last orientation, would have it.
TEST(Degenerate, MethodsGiveNothingWhenOneSideDoesNotTurn) {
  for (const ScaleMode mode : kModes) {
    const std::vector<PosePair> good = exact_poses(mode, synthetic::free_hand);
    std::vector<PosePair> frozen_eye = good;
    std::vector<PosePair> eye_does_not_turn = good;
    std::vector<PosePair> frozen_hand = good;
    std::vector<PosePair> hand_does_not_turn = good;
    for (std::size_t k = 0; k < good.size(); ++k) {
      frozen_eye[k].eye_from_scene = good[0].eye_from_scene;
      eye_does_not_turn[k].eye_from_scene.linear() = good[0].eye_from_scene.linear();
      frozen_hand[k].room_from_hand = good[0].room_from_hand;
      hand_does_not_turn[k].room_from_hand.linear() = good[0].room_from_hand.linear();
    }
    expect_nothing(mode, frozen_eye, "frozen eye");
    expect_nothing(mode, eye_does_not_turn, "eye does not turn");
    expect_nothing(mode, frozen_hand, "frozen hand");
    expect_nothing(mode, hand_does_not_turn, "hand does not turn");
  }
}

/// Of the two movements only one turns the eye: one line for Chen's method.
TEST(Degenerate, MethodsGiveNothingWhenTheEyeTurnsOnce) {
  for (const ScaleMode mode : kModes) {
    auto movements = all_movements(exact_poses(mode, synthetic::free_hand));
    movements = {movements[5], movements[200]};
    movements[0].eye_j_from_eye_i.linear().setIdentity();
    for (const Method& method : movement_methods(mode)) {
      EXPECT_FALSE(method.solve({.movements = movements})) << label(method, mode);
    }
  }
}

/// The likelihood gives an answer with the covariance it has, which the judge refuses (judge_test).
TEST(Degenerate, MethodsFromMovementsGiveNothingOnAFixedPointWithUnknownScale) {
  const auto movements = all_movements(exact_poses(ScaleMode::kUnknown, synthetic::pivot));
  for (const Method& method : movement_methods(ScaleMode::kUnknown)) {
    EXPECT_FALSE(method.solve({.movements = movements})) << method.name;
  }
}

TEST(Degenerate, MethodsGiveNothingOnNumbersThatAreNoPoses) {
  for (const ScaleMode mode : kModes) {
    const std::vector<PosePair> good = exact_poses(mode, synthetic::free_hand);
    const auto expect_refused = [&](const std::string& what, auto spoil) {
      std::vector<PosePair> broken = good;
      spoil(broken[7]);
      expect_nothing(mode, broken, what);
    };
    expect_refused("NaN", [](PosePair& pair) {
      pair.eye_from_scene.translation().y() = std::numeric_limits<double>::quiet_NaN();
    });
    expect_refused("infinity", [](PosePair& pair) {
      pair.room_from_hand.matrix()(0, 0) = std::numeric_limits<double>::infinity();
    });
    expect_refused("zero matrix", [](PosePair& pair) { pair.room_from_hand.linear().setZero(); });
    expect_refused("scaled rotation", [](PosePair& pair) { pair.eye_from_scene.linear() *= 1.01; });
    expect_refused("sheared rotation",
                   [](PosePair& pair) { pair.room_from_hand.linear()(0, 1) += 1e-3; });
    expect_refused("mirrored rotation",
                   [](PosePair& pair) { pair.eye_from_scene.linear().col(2) *= -1.0; });
  }
}

TEST(Degenerate, IsNoFixedPointWithKnownScale) {
  const Truth truth = synthetic::scope();
  const auto poses = exact_poses(ScaleMode::kKnown, synthetic::pivot);
  const auto movements = all_movements(poses);
  for (const Method& method : methods(ScaleMode::kKnown)) {
    const auto found = method.solve({.poses = poses, .movements = movements});
    ASSERT_TRUE(found) << method.name;
    expect_near(*found, truth.solution, 1e-8, std::string(method.name));
  }
}

}  // namespace
}  // namespace handeye
