// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_information.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace handeye::synthetic {
namespace {

constexpr double kStep = 1e-6;  // rad
constexpr double kStep_mm = 1e-4;
constexpr double kStep_s = 1e-4;
/// More frames than samples: then some combination of the interpolated poses has no noise at all,
/// but what lies between two samples is not known that well.
constexpr double kInterpolation = 0.003;  // of a sample's variance

// Unknowns that all frames share: hand_from_eye, time offset, lens.
constexpr int kOffset = 6;
constexpr int kLens = 7;
constexpr int kShared = kLens + kLensParameters;
using SharedVector = Eigen::Matrix<double, kShared, 1>;
using Rows6 = Eigen::Matrix<double, 6, Eigen::Dynamic>;

Pose stepped(const Pose& pose, const Vector6d& step) {
  Pose result = pose;
  result.linear() = exp_so3(step.head<3>()) * pose.linear();
  result.translation() += step.tail<3>();
  return result;
}

double step_of(int coordinate) {
  return coordinate % 6 < 3 ? kStep : kStep_mm;
}

Eigen::Vector2d pixel(const CameraModel& camera, const Pose& eye_from_room,
                      const Eigen::Vector3d& point) {
  return project<double>(camera, Eigen::Vector3d(eye_from_room * point));
}

/// The information matrix with the points already eliminated: shared unknowns first, then six of
/// each frame's pose.
class Information {
 public:
  explicit Information(const OneStepScene& scene)
      : scene_(scene),
        frames_(static_cast<int>(scene.tracks.eye_from_room.size())),
        matrix_(Eigen::MatrixXd::Zero(kShared + 6 * frames_, kShared + 6 * frames_)) {
    for (int i = 0; i < kLensParameters; ++i) {
      lens_step_[i] = 1e-6 * std::max(1.0, std::abs(lens_vector(scene.tracks.camera)[i]));
    }
    for (const Track& track : scene.tracks.tracks) add_track(track);
    add_hands();
    if (scene.lens_prior) {
      matrix_.diagonal().segment<kLensParameters>(kLens) +=
          scene.lens_prior->sigma.cwiseAbs2().cwiseInverse();
    }
  }

  OneStepBound bound() const {
    // Frames, then a lens that is known, leave the problem.
    const int poses = 6 * frames_;
    const Eigen::MatrixXd mixed = matrix_.bottomLeftCorner(poses, kShared);
    const Eigen::MatrixXd reduced =
        matrix_.topLeftCorner<kShared, kShared>() -
        mixed.transpose() * matrix_.bottomRightCorner(poses, poses).llt().solve(mixed);
    const int free = scene_.lens_prior ? kShared : kLens;
    const Eigen::MatrixXd information = reduced.topLeftCorner(free, free);
    const Eigen::VectorXd unit = information.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd covariance = unit.asDiagonal() *
                                       (unit.asDiagonal() * information * unit.asDiagonal())
                                           .ldlt()
                                           .solve(Eigen::MatrixXd::Identity(free, free)) *
                                       unit.asDiagonal();
    return {covariance.topLeftCorner<6, 6>(), std::sqrt(covariance(kOffset, kOffset))};
  }

 private:
  static int pose_of(int frame) { return kShared + 6 * frame; }

  void add_track(const Track& track) {
    const int n = static_cast<int>(track.pixels.size());
    const double weight = 1 / scene_.options.tracks.noise_px;
    const CameraModel& camera = scene_.tracks.camera;
    const LensVector lens = lens_vector(camera);
    std::vector<Eigen::Matrix<double, 2, 6>> by_pose;
    Eigen::Matrix<double, Eigen::Dynamic, kLensParameters> by_lens(2 * n, kLensParameters);
    Eigen::MatrixX3d by_point(2 * n, 3);
    for (int i = 0; i < n; ++i) {
      const Pose& eye = scene_.tracks.eye_from_room[static_cast<std::size_t>(track.first + i)];
      const Eigen::Vector3d& point = track.point_room;
      by_pose.emplace_back();
      for (int c = 0; c < 6; ++c) {
        const Vector6d step = step_of(c) * Vector6d::Unit(c);
        by_pose.back().col(c) =
            weight *
            (pixel(camera, stepped(eye, step), point) - pixel(camera, stepped(eye, -step), point)) /
            (2 * step_of(c));
      }
      for (int c = 0; c < 3; ++c) {
        const Eigen::Vector3d step = kStep_mm * Eigen::Vector3d::Unit(c);
        by_point.block<2, 1>(2 * i, c) =
            weight * (pixel(camera, eye, point + step) - pixel(camera, eye, point - step)) /
            (2 * kStep_mm);
      }
      for (int c = 0; c < kLensParameters; ++c) {
        const LensVector step = lens_step_[c] * LensVector::Unit(c);
        by_lens.block<2, 1>(2 * i, c) = weight *
                                        (pixel(with_lens(camera, lens + step), eye, point) -
                                         pixel(with_lens(camera, lens - step), eye, point)) /
                                        (2 * lens_step_[c]);
      }
    }
    // A point seen but once tells nothing. Its own three unknowns are projected away:
    // J^T (1 - Jp (Jp^T Jp)^-1 Jp^T) J.
    if (n < 2) return;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(by_point);
    const Eigen::MatrixXd range =
        qr.householderQ() * Eigen::MatrixXd::Identity(2 * n, static_cast<int>(qr.rank()));
    const auto lens_in_range = (range.transpose() * by_lens).eval();
    Eigen::MatrixXd poses_in_range(range.cols(), 6 * n);
    for (int i = 0; i < n; ++i) {
      poses_in_range.middleCols<6>(6 * i) =
          range.middleRows<2>(2 * i).transpose() * by_pose[static_cast<std::size_t>(i)];
    }
    const int first = pose_of(track.first);
    matrix_.block<kLensParameters, kLensParameters>(kLens, kLens) +=
        by_lens.transpose() * by_lens - lens_in_range.transpose() * lens_in_range;
    matrix_.block(first, kLens, 6 * n, kLensParameters) -=
        poses_in_range.transpose() * lens_in_range;
    matrix_.block(first, first, 6 * n, 6 * n).noalias() -=
        poses_in_range.transpose() * poses_in_range;
    for (int i = 0; i < n; ++i) {
      const auto& rows = by_pose[static_cast<std::size_t>(i)];
      matrix_.block<6, kLensParameters>(first + 6 * i, kLens) +=
          rows.transpose() * by_lens.middleRows<2>(2 * i);
      matrix_.block<6, 6>(first + 6 * i, first + 6 * i) += rows.transpose() * rows;
    }
  }

  /// What the tracker would say of the frame: hand_from_eye and the pose stepped, and how the hand
  /// moves on when time is off.
  Pose hand(int frame, const Vector6d& eye_step, const SharedVector& shared) const {
    const Pose eye_from_room =
        stepped(scene_.tracks.eye_from_room[static_cast<std::size_t>(frame)], eye_step);
    const Pose hand_from_eye = stepped(scene_.hand_from_eye, shared.head<6>());
    const double from_s = scene_.options.tracks.from_s + frame / scene_.options.tracks.rate_hz;
    const Pose moved_on = scene_.options.tracks.motion(from_s).inverse() *
                          scene_.options.tracks.motion(from_s + shared[kOffset]);
    return eye_from_room.inverse() * moved_on * hand_from_eye.inverse();
  }

  /// Derivative by the shared unknowns and by the six of the frame's own pose.
  Eigen::Matrix<double, 6, kShared + 6> hand_rows(int frame) const {
    Eigen::Matrix<double, 6, kShared + 6> rows = Eigen::Matrix<double, 6, kShared + 6>::Zero();
    const auto difference = [&](const Vector6d& eye_step, const SharedVector& shared,
                                double length) {
      const Pose after = hand(frame, eye_step, shared);
      const Pose before = hand(frame, -eye_step, -shared);
      Vector6d result;
      result << log_so3(after.linear() * before.linear().transpose()),
          after.translation() - before.translation();
      return Vector6d(result / (2 * length));
    };
    for (int c = 0; c < kLens; ++c) {
      const double length = c == kOffset ? kStep_s : step_of(c);
      rows.col(c) = difference(Vector6d::Zero(), length * SharedVector::Unit(c), length);
    }
    for (int c = 0; c < 6; ++c) {
      rows.col(kShared + c) =
          difference(step_of(c) * Vector6d::Unit(c), SharedVector::Zero(), step_of(c));
    }
    return rows;
  }

  /// Of the interpolated hands of frames from..to, which hang together by shared samples.
  Eigen::MatrixXd covariance(const std::vector<int>& chain) const {
    const auto part_of_sample = [&](int frame, std::int64_t sample) {
      const HandAtFrame& hand = *scene_.problem.frames[static_cast<std::size_t>(frame)].hand;
      const std::int64_t at = sample - hand.sample;
      const bool has = at >= 0 && at < static_cast<std::int64_t>(hand.shares.size());
      return has ? hand.shares[static_cast<std::size_t>(at)] : 0.0;
    };
    const auto size = static_cast<Eigen::Index>(6 * chain.size());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const std::int64_t first =
          scene_.problem.frames[static_cast<std::size_t>(chain[i])].hand->sample;
      for (std::size_t j = 0; j < chain.size(); ++j) {
        for (const std::int64_t sample : {first, first + 1}) {
          double share = part_of_sample(chain[i], sample) * part_of_sample(chain[j], sample);
          if (share == 0) continue;
          if (i == j) share += kInterpolation;
          result.block<6, 6>(static_cast<Eigen::Index>(6 * i), static_cast<Eigen::Index>(6 * j)) +=
              share * scene_.sample_covariance[static_cast<std::size_t>(sample)];
        }
      }
    }
    return result;
  }

  void add_hands() {
    std::vector<int> chain;
    for (int frame = 0; frame < frames_; ++frame) {
      const auto& hand = scene_.problem.frames[static_cast<std::size_t>(frame)].hand;
      if (!hand) continue;
      const bool shares =
          !chain.empty() &&
          hand->sample <=
              scene_.problem.frames[static_cast<std::size_t>(chain.back())].hand->sample + 1;
      if (!shares) add_chain(chain);
      chain.push_back(frame);
    }
    add_chain(chain);
  }

  /// Adds its information and empties it.
  void add_chain(std::vector<int>& chain) {
    if (chain.empty()) return;
    const auto n = static_cast<Eigen::Index>(chain.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6 * n, kShared + 6 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto own = hand_rows(chain[static_cast<std::size_t>(i)]);
      rows.block<6, kShared>(6 * i, 0) = own.leftCols<kShared>();
      rows.block<6, 6>(6 * i, kShared + 6 * i) = own.rightCols<6>();
    }
    const Eigen::MatrixXd whitened = covariance(chain).llt().matrixL().solve(rows);
    const Eigen::MatrixXd added = whitened.transpose() * whitened;
    const auto place = [&](Eigen::Index i) {
      return i < 0 ? 0 : pose_of(chain[static_cast<std::size_t>(i)]);
    };
    const auto in_rows = [](Eigen::Index i) { return i < 0 ? 0 : kShared + 6 * i; };
    const auto length = [](Eigen::Index i) { return i < 0 ? kShared : 6; };
    for (Eigen::Index i = -1; i < n; ++i) {
      for (Eigen::Index j = -1; j < n; ++j) {
        matrix_.block(place(i), place(j), length(i), length(j)) +=
            added.block(in_rows(i), in_rows(j), length(i), length(j));
      }
    }
    chain.clear();
  }

  const OneStepScene& scene_;
  int frames_;
  LensVector lens_step_;
  Eigen::MatrixXd matrix_;
};

}  // namespace

OneStepBound one_step_bound(const OneStepScene& scene) {
  return Information(scene).bound();
}

}  // namespace handeye::synthetic
