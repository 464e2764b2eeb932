// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include <Eigen/SVD>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "daemon/handeye/methods/methods.hpp"
#include "tests/unit/handeye/draw.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// Every method of both tables on exact data: what it may lose is what double precision takes.
namespace handeye {
namespace {

using synthetic::Draw;

constexpr double kRotationTolerance_rad = 1e-9;
constexpr double kTranslationTolerance = 1e-8;  // of the larger of |t_X| and the mean |t_H|
constexpr double kScaleTolerance = 1e-10;
constexpr double kMaxCondition = 1e3;

enum class Angles { kAny, kNearHalfTurn, kSome };

struct Shape {
  std::uint32_t seed{0};
  int movements{2};
  Angles angles{Angles::kAny};
  Angles angle_of_x{Angles::kAny};
  bool narrow_axes{false};
  bool pivots{false};  ///< all movements keep one point
};

void showValue(const Shape& shape, std::ostream& out) {
  out << fmt::format("seed {}, {} movements, angles {}, X {}, narrow {}, pivots {}", shape.seed,
                     shape.movements, static_cast<int>(shape.angles),
                     static_cast<int>(shape.angle_of_x), shape.narrow_axes, shape.pivots);
}

rc::Gen<Shape> any_shape(bool may_pivot) {
  const auto angles = rc::gen::element(Angles::kAny, Angles::kNearHalfTurn, Angles::kSome);
  return rc::gen::apply(
      [may_pivot](std::uint32_t seed, int few, int many, bool is_few, Angles of_movements,
                  Angles of_x, bool narrow, int pivot) {
        return Shape{seed,   is_few ? few : many,    of_movements, of_x,
                     narrow, may_pivot && pivot == 0};
      },
      rc::gen::resize(100, rc::gen::arbitrary<std::uint32_t>()), rc::gen::inRange(2, 6),
      rc::gen::inRange(6, 60), rc::gen::arbitrary<bool>(), angles, angles,
      rc::gen::arbitrary<bool>(), rc::gen::inRange(0, 5));
}

double draw_angle(Angles angles, Draw& draw) {
  const bool half_turn =
      angles == Angles::kNearHalfTurn || (angles == Angles::kSome && draw.uniform(0, 1) < 0.3);
  return half_turn ? kPi - draw.power_of_ten(-6, -1) : draw.uniform(0.05, kPi - 1e-6);
}

struct Configuration {
  HandEyeSolution truth;
  std::vector<PosePair> poses;
  std::vector<Movement> movements;
  double length_mm{1};  ///< what translations are relative to
};

Pose pose_of(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

Configuration configuration_of(const Shape& shape, ScaleMode mode) {
  Draw draw(shape.seed);
  Configuration made;
  made.truth.scale_units_per_mm = mode == ScaleMode::kKnown ? 1.0 : draw.power_of_ten(-6, 6);
  made.truth.hand_from_eye = pose_of(exp_so3(draw_angle(shape.angle_of_x, draw) * draw.direction()),
                                     draw.power_of_ten(0, 3.5) * draw.direction());
  const Pose room_from_scene = pose_of(exp_so3(2.0 * draw.normal3()), 2000.0 * draw.normal3());
  const Pose first = pose_of(exp_so3(2.0 * draw.normal3()), 2000.0 * draw.normal3());
  const Eigen::Vector3d middle_axis = draw.direction();
  const double spread = shape.narrow_axes ? draw.power_of_ten(-2.5, 0) : 1e3;
  const double travel_mm = draw.power_of_ten(1, 3.7);
  const Eigen::Vector3d fixed_point = travel_mm * draw.direction();

  const int count = shape.movements;
  std::vector<Pose> room_from_hand{first};
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d axis = (middle_axis + spread * draw.direction()).normalized();
    const Eigen::Matrix3d turn = exp_so3(draw_angle(shape.angles, draw) * axis);
    const Eigen::Vector3d shift = shape.pivots ? Eigen::Vector3d(fixed_point - turn * fixed_point)
                                               : travel_mm * draw.normal3();
    room_from_hand.push_back(first * pose_of(turn, shift).inverse());
  }
  for (const Pose& hand : room_from_hand) {
    PosePair pair{hand, made.truth.hand_from_eye.inverse() * hand.inverse() * room_from_scene};
    pair.eye_from_scene.translation() *= made.truth.scale_units_per_mm;
    made.poses.push_back(pair);
  }
  double mean_mm = 0;
  for (int k = 1; k <= shape.movements; ++k) {
    made.movements.push_back(
        movement_between(made.poses[0], made.poses[static_cast<std::size_t>(k)]));
    mean_mm += made.movements.back().hand_j_from_hand_i.translation().norm() / shape.movements;
  }
  made.length_mm = std::max(made.truth.hand_from_eye.translation().norm(), mean_mm);
  return made;
}

double condition_of(Eigen::MatrixXd matrix) {
  matrix = (matrix * matrix.colwise().norm().cwiseInverse().asDiagonal()).eval();
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values[0] / values[values.size() - 1];
}

/// The larger condition, columns scaled, of the two linear systems at the truth: of the rotation's
/// (the change of q_E q - q q_H with a turn of R_X) and of eq 6, without its column of the scale
/// where that is known.
double condition(const Configuration& made, ScaleMode mode) {
  const auto n = static_cast<Eigen::Index>(made.movements.size());
  const Eigen::Matrix3d rotation = made.truth.hand_from_eye.linear().transpose();
  Eigen::MatrixXd turns(3 * n, 3);
  Eigen::MatrixXd eq6(3 * n, mode == ScaleMode::kKnown ? 3 : 4);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& [hand, eye] = made.movements[static_cast<std::size_t>(k)];
    turns.middleRows<3>(3 * k) = skew(Eigen::Quaterniond(eye.linear()).vec());
    eq6.block<3, 3>(3 * k, 0) = Eigen::Matrix3d::Identity() - eye.linear();
    if (mode == ScaleMode::kUnknown) eq6.block<3, 1>(3 * k, 3) = rotation * hand.translation();
  }
  return std::max(condition_of(turns), condition_of(eq6));
}

struct Errors {
  double rotation_rad{0};
  double translation{0};
  double scale{0};
};

Errors errors_of(const HandEyeSolution& found, const Configuration& made) {
  const Pose& truth = made.truth.hand_from_eye;
  return {
      rotation_angle_rad(found.hand_from_eye.linear(), truth.linear()),
      (found.hand_from_eye.translation() - truth.translation()).norm() / made.length_mm,
      std::abs(found.scale_units_per_mm / made.truth.scale_units_per_mm - 1.0),
  };
}

void check_all_methods(ScaleMode mode) {
  setenv("RC_PARAMS", "seed=5 max_success=1000", 0);  // the environment may ask for others
  std::map<std::string_view, Errors> worst;
  EXPECT_TRUE(rc::check("every method recovers X", [&] {
    const Shape shape = *any_shape(mode == ScaleMode::kKnown);
    const Configuration made = configuration_of(shape, mode);
    const double ill = condition(made, mode);
    RC_PRE(ill < kMaxCondition);
    RC_CLASSIFY(ill > 100, "condition above 100");
    RC_CLASSIFY(shape.angles == Angles::kNearHalfTurn, "all movements near half a turn");
    RC_CLASSIFY(shape.angle_of_x == Angles::kNearHalfTurn, "X near half a turn");
    RC_CLASSIFY(shape.movements == 2, "two movements");
    RC_CLASSIFY(shape.pivots, "fixed point");
    for (const Method& method : methods(mode)) {
      const auto found = method.solve({.poses = made.poses, .movements = made.movements});
      if (!found) RC_FAIL(fmt::format("{} gives nothing", method.name));
      const Errors errors = errors_of(*found, made);
      Errors& most = worst[method.name];
      most.rotation_rad = std::max(most.rotation_rad, errors.rotation_rad);
      most.translation = std::max(most.translation, errors.translation);
      most.scale = std::max(most.scale, errors.scale);
      if (!(errors.rotation_rad < kRotationTolerance_rad &&
            errors.translation < kTranslationTolerance && errors.scale < kScaleTolerance)) {
        RC_FAIL(fmt::format("{}: {:.1e} rad, {:.1e} of the translation, {:.1e} of the scale",
                            method.name, errors.rotation_rad, errors.translation, errors.scale));
      }
    }
  }));
  for (const Method& method : methods(mode)) {
    const Errors& most = worst[method.name];
    fmt::print("{:26} at most {:.1e} rad, {:.1e} of the translation, {:.1e} of the scale\n",
               method.name, most.rotation_rad, most.translation, most.scale);
  }
}

TEST(Exactness, OfEveryMethodWithKnownScale) {
  check_all_methods(ScaleMode::kKnown);
}

TEST(Exactness, OfEveryMethodWithUnknownScale) {
  check_all_methods(ScaleMode::kUnknown);
}

}  // namespace
}  // namespace handeye
