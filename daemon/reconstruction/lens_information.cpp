// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/lens_information.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

constexpr Eigen::Index kPose = 6;
/// Trackers err together by about this much, however small the residuals: interpolation, windows
/// seen aslant, a lens that is not quite of the model's kind.
constexpr double kLeastNoisePx = 0.1;

using Matrix26 = Eigen::Matrix<double, 2, 6>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

/// An observation linearised; rows are weighted by the square root of the loss's weight.
struct Row {
  Eigen::Index keyframe{0};
  Matrix26 by_pose;
  Matrix23 by_point;
  Matrix26 by_lens;
  Eigen::Vector2d error_px;
};

/// Normal equations over all poses and, last, the lens, the points eliminated track by track.
class ReducedSystem {
 public:
  ReducedSystem(const CameraModel& camera, const LensFreedom& freedom, double robust_px,
                const Scene& scene)
      : camera_(camera),
        freedom_(freedom),
        robust_px_(robust_px),
        scene_(scene),
        poses_(static_cast<Eigen::Index>(scene.keyframes.size())),
        lens_at_(kPose * poses_),
        normal_(Eigen::MatrixXd::Zero(lens_at_ + kLensParameters, lens_at_ + kLensParameters)) {}

  std::optional<LensInformation> solve() {
    for (const Track& track : scene_.tracks) add_track(track);
    const double unknowns = static_cast<double>(lens_at_) + 3.0 * tracks_used_ - 7.0;
    const double freedom = 2.0 * observations_ - unknowns;
    if (poses_ < 3 || freedom < 1.0) return std::nullopt;
    const double noise_px = std::sqrt(squares_px2_ / freedom);
    const double variance_px2 = std::pow(std::max(noise_px, kLeastNoisePx), 2);
    add_prior(variance_px2);
    fix_gauge();
    const Eigen::LDLT<Eigen::MatrixXd> factor(normal_.selfadjointView<Eigen::Lower>());
    if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
    Eigen::MatrixXd by_lens = Eigen::MatrixXd::Zero(normal_.rows(), kLensParameters);
    by_lens.bottomRows<kLensParameters>().setIdentity();
    by_lens = factor.solve(by_lens);

    LensInformation information;
    information.noise_px = noise_px;
    const LensMatrix inverse = by_lens.bottomRows<kLensParameters>();
    const double shrunk = 2.0 * observations_ / freedom;
    information.covariance =
        wider(variance_px2 * inverse, std::pow(shrunk, 2) * spread_of_tracks(by_lens));
    if (!information.covariance.allFinite()) return std::nullopt;
    write_response(by_lens, inverse, information);
    return information;
  }

 private:
  bool is_free(int parameter) const { return freedom_.free[static_cast<std::size_t>(parameter)]; }

  /// The rows of a track; empty where it has no point or too few observations.
  const std::vector<Row>& linearise(const Track& track) {
    rows_.clear();
    if (!track.has_point) return rows_;
    for (const TrackObservation& seen : track.observations) {
      if (!seen.inlier) continue;
      const Pose& pose = scene_.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene;
      const Eigen::Vector3d rotated = pose.linear() * track.point_scene;
      const Eigen::Vector3d point_eye = rotated + pose.translation();
      if (!(point_eye.z() > 0)) continue;
      const Projection projection = project_with_derivative(camera_, point_eye);
      const Eigen::Vector2d error_px = projection.pixel - seen.pixel;
      const double weight = std::sqrt(std::min(1.0, robust_px_ / error_px.norm()));
      Row& row = rows_.emplace_back();
      row.keyframe = seen.keyframe;
      row.by_pose << -projection.by_point_eye * skew(rotated), projection.by_point_eye;
      row.by_pose *= weight;
      row.by_point = weight * projection.by_point_eye * pose.linear();
      row.by_lens = weight * pixel_by_lens(camera_, point_eye);
      for (int i = 0; i < kLensParameters; ++i) {
        if (!is_free(i)) row.by_lens.col(i).setZero();
      }
      row.error_px = weight * error_px;
    }
    if (rows_.size() < 2) rows_.clear();
    return rows_;
  }

  void add_track(const Track& track) {
    if (linearise(track).empty()) return;
    Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
    Matrix63 lens_point = Matrix63::Zero();
    couplings_.clear();
    for (const Row& row : rows_) {
      const Eigen::Index at = kPose * row.keyframe;
      point += row.by_point.transpose() * row.by_point;
      lens_point += row.by_lens.transpose() * row.by_point;
      couplings_.push_back(row.by_pose.transpose() * row.by_point);
      normal_.block<6, 6>(at, at) += row.by_pose.transpose() * row.by_pose;
      normal_.block<6, 6>(lens_at_, at) += row.by_lens.transpose() * row.by_pose;
      normal_.block<6, 6>(lens_at_, lens_at_) += row.by_lens.transpose() * row.by_lens;
      squares_px2_ += row.error_px.squaredNorm();
    }
    const Eigen::Matrix3d inverse = point.inverse();
    if (!inverse.allFinite()) return;
    observations_ += static_cast<double>(rows_.size());
    ++tracks_used_;
    const Matrix63 lens_eliminated = lens_point * inverse;
    normal_.block<6, 6>(lens_at_, lens_at_) -= lens_eliminated * lens_point.transpose();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Eigen::Index at = kPose * rows_[i].keyframe;
      normal_.block<6, 6>(lens_at_, at) -= lens_eliminated * couplings_[i].transpose();
      const Matrix63 eliminated = couplings_[i] * inverse;
      for (std::size_t j = 0; j <= i; ++j) {
        normal_.block<6, 6>(at, kPose * rows_[j].keyframe) -=
            eliminated * couplings_[j].transpose();
      }
    }
  }

  /// Weighed against the noise as it was found: what only the prior knows keeps the prior's sigma.
  void add_prior(double variance_px2) {
    for (int i = 0; i < kLensParameters; ++i) {
      const double sigma = is_free(i) ? freedom_.prior.sigma[i] : 1.0;
      // What is held must only not make the system singular; its solution is thrown away.
      normal_(lens_at_ + i, lens_at_ + i) += variance_px2 / (sigma * sigma);
    }
  }

  /// Holds the first pose, and the translation of the farthest along the way it went.
  void fix_gauge() {
    const Pose scene_from_first = scene_.keyframes.front().eye_from_scene.inverse();
    Eigen::Index farthest = 1;
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 1; k < poses_; ++k) {
      const Pose& pose = scene_.keyframes[static_cast<std::size_t>(k)].eye_from_scene;
      const Eigen::Vector3d moved = (pose * scene_from_first).translation();
      if (moved.norm() <= way.norm()) continue;
      farthest = k;
      way = moved;
    }
    for (Eigen::Index i = 0; i < kPose; ++i) normal_(i, i) *= 1e8;
    const Eigen::Index at = kPose * farthest + 3;
    const double stiffness = 1e8 * normal_.block<3, 3>(at, at).trace();
    const Eigen::Vector3d direction = way.normalized();
    normal_.block<3, 3>(at, at) += stiffness * direction * direction.transpose();
  }

  /// Sum over the tracks of the outer products of what each of them moves the lens by, its point
  /// following.
  LensMatrix spread_of_tracks(const Eigen::MatrixXd& by_lens) {
    LensMatrix spread = LensMatrix::Zero();
    for (const Track& track : scene_.tracks) {
      LensVector pull = LensVector::Zero();
      Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
      Eigen::Vector3d point_pull = Eigen::Vector3d::Zero();
      Matrix63 pull_by_point = Matrix63::Zero();
      for (const Row& row : linearise(track)) {
        const Eigen::Matrix<double, kLensParameters, 2> by_error =
            by_lens.middleRows<kPose>(kPose * row.keyframe).transpose() * row.by_pose.transpose() +
            by_lens.bottomRows<kLensParameters>().transpose() * row.by_lens.transpose();
        pull += by_error * row.error_px;
        pull_by_point += by_error * row.by_point;
        point += row.by_point.transpose() * row.by_point;
        point_pull += row.by_point.transpose() * row.error_px;
      }
      if (rows_.empty()) continue;
      pull -= pull_by_point * point.ldlt().solve(point_pull);
      spread += pull * pull.transpose();
    }
    return spread;
  }

  /// The first covariance, widened in every direction to the second where that is larger.
  LensMatrix wider(const LensMatrix& first, const LensMatrix& second) const {
    LensMatrix result = LensMatrix::Zero();
    std::vector<int> free;
    for (int i = 0; i < kLensParameters; ++i) {
      if (is_free(i)) free.push_back(i);
    }
    const Eigen::MatrixXd base = first(free, free);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(second(free, free).eval(),
                                                                          base);
    const Eigen::MatrixXd directions = base * eigen.eigenvectors();
    result(free, free) =
        directions * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() * directions.transpose();
    return result;
  }

  /// d pose / d lens = (covariance of pose and lens) (covariance of lens)^-1: what poses do when
  /// the lens is moved and they may follow.
  void write_response(const Eigen::MatrixXd& by_lens, const LensMatrix& inverse,
                      LensInformation& information) const {
    const LensMatrix lens_information = inverse.inverse();
    for (Eigen::Index k = 0; k < poses_; ++k) {
      information.pose_by_lens.push_back(by_lens.middleRows<kPose>(kPose * k) * lens_information);
    }
  }

  const CameraModel& camera_;
  const LensFreedom& freedom_;
  double robust_px_;
  const Scene& scene_;
  Eigen::Index poses_;
  Eigen::Index lens_at_;
  Eigen::MatrixXd normal_;  ///< lower triangle
  double squares_px2_{0};
  double observations_{0};
  double tracks_used_{0};
  std::vector<Row> rows_;            ///< of the track at hand
  std::vector<Matrix63> couplings_;  ///< of its poses and its point
};

}  // namespace

std::optional<LensInformation> lens_information(const CameraModel& camera,
                                                const LensFreedom& freedom, double robust_px,
                                                const Scene& scene) {
  return ReducedSystem(camera, freedom, robust_px, scene).solve();
}

}  // namespace handeye
