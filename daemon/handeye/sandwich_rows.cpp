// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/sandwich_rows.hpp"

#include <cmath>

#include <ceres/jet.h>

namespace handeye::sandwich {
namespace {

// Eigen's names for T that is a Jet.
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Quaternion = Eigen::Quaternion<T>;
template <typename T>
using RowVector = Eigen::Matrix<T, Eigen::Dynamic, 1, 0, LinearRows::kMost, 1>;

using Variable = ceres::Jet<double, 12>;  // delta, epsilon, shape

/// One movement whose eye side, and X's nine entries, vary; translations in the rows' unit.
struct Varied {
  Quaternion<Variable> q_eye;
  Vector3<Variable> t_eye;
  Matrix3<Variable> entries;  ///< of R_X
  Quaternion<Variable> q_hand;
  Vector3<Variable> t_hand;
  Quaternion<Variable> q;  ///< of R_X
  Vector3<Variable> t;     ///< of X
};

Quaternion<Variable> small_turn(const Vector3<Variable>& w) {
  return {Variable(1), 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z()};
}

Matrix3<Variable> cross(const Vector3<Variable>& v) {
  Matrix3<Variable> matrix;
  matrix << Variable(0), -v.z(), v.y(), v.z(), Variable(0), -v.x(), -v.y(), v.x(), Variable(0);
  return matrix;
}

Matrix3<Variable> symmetric(const Eigen::Matrix<Variable, 6, 1>& s) {
  Matrix3<Variable> matrix;
  matrix << s[0] + s[5], s[4], s[3], s[4], s[1] + s[5], s[2], s[3], s[2], s[5] - s[0] - s[1];
  return matrix;
}

Varied vary(const Pose& hand, const Pose& eye_from_hand, double unit_mm) {
  Eigen::Matrix<Variable, 12, 1> x;
  for (int k = 0; k < 12; ++k) x[k] = Variable(0.0, k);
  Varied v;
  v.q_hand = Eigen::Quaterniond(hand.linear()).cast<Variable>();
  v.t_hand = (hand.translation() / unit_mm).cast<Variable>();
  v.q = Eigen::Quaterniond(eye_from_hand.linear()).cast<Variable>();
  v.t = (eye_from_hand.translation() / unit_mm).cast<Variable>();
  v.q_eye = small_turn(-x.head<3>()) * (v.q * v.q_hand * v.q.conjugate());
  v.t_eye = v.t - v.q_eye * v.t + v.q * v.t_hand - x.segment<3>(3) / Variable(unit_mm);
  const Matrix3<Variable> rotation = v.q.toRotationMatrix();
  v.entries = rotation + symmetric(x.tail<6>()) * rotation;
  return v;
}

Eigen::Matrix<Variable, 4, 1> coefficients(const Quaternion<Variable>& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Quaternion<Variable> pure(const Vector3<Variable>& v) {
  return {Variable(0), v.x(), v.y(), v.z()};
}

Quaternion<Variable> dual_part(const Quaternion<Variable>& q, const Vector3<Variable>& t) {
  Quaternion<Variable> dual = pure(t) * q;
  dual.coeffs() *= Variable(0.5);
  return dual;
}

Eigen::Matrix<Variable, 4, 1> quaternion_rows(const Varied& v) {
  return coefficients(v.q_eye * v.q) - coefficients(v.q * v.q_hand);
}

Vector3<Variable> translation_rows(const Varied& v) {
  return v.t - v.q_eye * v.t - v.t_eye + v.entries * v.t_hand;
}

Eigen::Matrix<Variable, 9, 1> entry_rows(const Varied& v) {
  const Matrix3<Variable> difference =
      v.q_eye.toRotationMatrix() * v.entries - v.entries * v.q_hand.toRotationMatrix();
  return difference.reshaped();
}

Vector3<Variable> logarithm(const Quaternion<Variable>& q) {
  const Variable sine = q.vec().norm();
  return q.vec() * (2.0 * atan2(sine, q.w()) / sine);
}

/// skew(P_E + P_H) P' - (P_H - P_E), in a hand frame turned so that P' is not large.
Vector3<Variable> gibbs_rows(const Varied& v) {
  Quaternion<Variable> turned = Quaternion<Variable>::Identity();
  if (std::abs(v.q.w().a) < 0.5) {
    const Eigen::Vector3d entries(v.q.x().a, v.q.y().a, v.q.z().a);
    Eigen::Index largest = 0;
    entries.cwiseAbs().maxCoeff(&largest);
    turned = pure(Vector3<Variable>::Unit(largest));
  }
  const Quaternion<Variable> rest = v.q * turned.conjugate();
  const Vector3<Variable> gibbs = rest.vec() / rest.w();
  const Vector3<Variable> hand = turned * v.q_hand.vec();
  const Vector3<Variable> sum = v.q_eye.vec() + hand;
  return sum.cross(gibbs) - hand + v.q_eye.vec();
}

/// What is left of the entries less n_E n_H^T when the two directions of the unknown turn about the
/// axis are taken out.
Eigen::Matrix<Variable, 9, 1> axis_frame_rows(const Varied& v) {
  const Vector3<Variable> n_hand = v.q_hand.vec().normalized();
  const Vector3<Variable> n_eye = v.q_eye.vec().normalized();
  // From R_X n_H to n_E on the shortest way: any rotation that takes n_H to n_E serves.
  const Vector3<Variable> carried = v.q * n_hand;
  const Matrix3<Variable> turn = cross(carried.cross(n_eye));
  const Matrix3<Variable> shortest =
      Matrix3<Variable>::Identity() + turn + turn * turn / (Variable(1) + carried.dot(n_eye));
  const Matrix3<Variable> r0 = shortest * v.q.toRotationMatrix();
  const Matrix3<Variable> along = n_eye * n_hand.transpose();
  const Matrix3<Variable> cosine = (r0 - along) / sqrt(Variable(2));
  const Matrix3<Variable> sine = cross(n_eye) * r0 / sqrt(Variable(2));
  Matrix3<Variable> left = v.entries - along;
  left -= cosine * left.cwiseProduct(cosine).sum() + sine * left.cwiseProduct(sine).sum();
  return left.reshaped();
}

/// m_E - R_X m_H - t_X x l_E.
Vector3<Variable> moment_rows(const Varied& v) {
  const auto moment = [](const Quaternion<Variable>& q, const Vector3<Variable>& t) {
    const Variable sine = q.vec().norm();
    const Vector3<Variable> direction = q.vec() / sine;
    const Vector3<Variable> across = t.cross(direction);
    return Vector3<Variable>(Variable(0.5) * (across + direction.cross(across) * (q.w() / sine)));
  };
  return moment(v.q_eye, v.t_eye) - v.q * moment(v.q_hand, v.t_hand) -
         v.t.cross(v.q_eye.vec().normalized());
}

/// Vector parts of q_E q - q q_H and of its dual, the scalar parts of q_E and q_H left out.
Eigen::Matrix<Variable, 6, 1> dual_vector_rows(const Varied& v) {
  const Quaternion<Variable> eye = pure(v.q_eye.vec());
  const Quaternion<Variable> hand = pure(v.q_hand.vec());
  const Quaternion<Variable> eye_dual = pure(dual_part(v.q_eye, v.t_eye).vec());
  const Quaternion<Variable> hand_dual = pure(dual_part(v.q_hand, v.t_hand).vec());
  const Quaternion<Variable> dual = dual_part(v.q, v.t);
  Eigen::Matrix<Variable, 6, 1> rows;
  rows << (eye * v.q).vec() - (v.q * hand).vec(),
      (eye_dual * v.q).vec() - (v.q * hand_dual).vec() + (eye * dual).vec() - (dual * hand).vec();
  return rows;
}

/// With the eye in mm, where the scale is 1.
Eigen::Matrix<Variable, 8, 1> similarity_rows(const Varied& v) {
  const Quaternion<Variable> dual = dual_part(v.q, v.t);
  Eigen::Matrix<Variable, 8, 1> rows;
  rows << quaternion_rows(v),
      coefficients(v.q_eye * dual) + coefficients(dual_part(v.q_eye, v.t_eye) * v.q) -
          coefficients(v.q * dual_part(v.q_hand, v.t_hand)) - coefficients(dual * v.q_hand);
  return rows;
}

RowVector<Variable> evaluate(Rows rows, const Varied& v) {
  RowVector<Variable> result;
  switch (rows) {
    case Rows::kTranslation:
      return translation_rows(v);
    case Rows::kQuaternions:
      return quaternion_rows(v);
    case Rows::kLogarithms:
      return logarithm(v.q_eye) - v.q * logarithm(v.q_hand);
    case Rows::kAxes:
      return v.q_eye.vec().normalized() - v.q * v.q_hand.vec().normalized();
    case Rows::kGibbsVector:
      return gibbs_rows(v);
    case Rows::kAxisFrames:
      return axis_frame_rows(v);
    case Rows::kScrewMoments:
      return moment_rows(v);
    case Rows::kQuaternionsTranslation:
      result.resize(7);
      result << quaternion_rows(v), translation_rows(v);
      return result;
    case Rows::kDualQuaternionVectors:
      return dual_vector_rows(v);
    case Rows::kSimilarityQuaternions:
      return similarity_rows(v);
    case Rows::kEntriesTranslation:
      result.resize(12);
      result << entry_rows(v), translation_rows(v);
      return result;
  }
  return result;
}

}  // namespace

LinearRows linear_rows(Rows rows, const Pose& hand_j_from_hand_i, const Pose& eye_from_hand,
                       double unit_mm) {
  const RowVector<Variable> varied =
      evaluate(rows, vary(hand_j_from_hand_i, eye_from_hand, unit_mm));
  LinearRows linear;
  linear.of_error.resize(varied.size(), 6);
  linear.of_shape.resize(varied.size(), 6);
  for (Eigen::Index k = 0; k < varied.size(); ++k) {
    linear.of_error.row(k) = varied[k].v.head<6>();
    linear.of_shape.row(k) = varied[k].v.tail<6>();
  }
  return linear;
}

}  // namespace handeye::sandwich
