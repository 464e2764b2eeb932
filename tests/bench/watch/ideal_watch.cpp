// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/watch/ideal_watch.hpp"

#include <algorithm>

#include <Eigen/Dense>

namespace handeye::test {
namespace {

/// Frames that are taken as one bundle: 8 s at 12.5 Hz. Those before count as if nothing of theirs
/// were seen again.
constexpr std::size_t kStretch = 100;
constexpr std::size_t kLeastFrames = 4;
constexpr std::int64_t kEvery = 3;  ///< frames from one computation to the next
constexpr std::size_t kAllSights = 1'000'000;
constexpr double kNoBend = 1e6;  ///< no loss but least squares, for there are no outliers

}  // namespace

void IdealWatch::see(const WatchScene& scene) {
  const TrackedFrame& tracked = scene.frame();
  if (scene.hand_hidden() || tracked.observations.empty()) return;
  if (frames_.size() == kStretch) {
    closed_ += information();
    frames_.clear();
    truth_.room_from_eye.clear();
  }
  TrackedFrame steady = tracked;
  std::erase_if(steady.observations,
                [&](const Observation& seen) { return scene.slides(seen.feature_id); });
  // Between two samples of a tracker, on average over where between them.
  const HandLookup hand{
      .status = LookupStatus::kOk, .room_from_hand = scene.room_from_hand(), .fraction = 0.21};
  frames_.push_back(make_watch_frame(calibration_.camera, steady, hand, calibration_.hand_noise));
  truth_.hand_from_eye = scene.hand_from_eye();
  truth_.start = truth_.hand_from_eye;
  truth_.room_from_eye.push_back(scene.room_from_hand() * truth_.hand_from_eye);
  if (frames_.size() < kLeastFrames || tracked.index % kEvery != 0) return;

  const Matrix6d all = closed_ + information();
  const Matrix6d covariance = all.inverse() + calibration_.covariance;
  const Eigen::Vector3d off =
      log_so3(truth_.hand_from_eye.linear() * calibration_.hand_from_eye.linear().transpose());
  chi2_ = off.dot(covariance.topLeftCorner<3, 3>().inverse() * off);
}

Matrix6d IdealWatch::information() const {
  WatchUnknowns at = truth_;
  at.tracks = watch_tracks(frames_, 2, kAllSights);
  place_points(at.room_from_eye, at.tracks);
  const double image =
      calibration_.image_noise_px / (0.5 * (calibration_.camera.fx + calibration_.camera.fy));
  const WatchWeights weights{.image = image, .robust_image = kNoBend * image};
  const WatchEquations equations(frames_, at, weights, 0.0);
  const Eigen::LLT<Eigen::MatrixXd> factor(equations.matrix());
  const Eigen::Index size = equations.matrix().rows();
  const Eigen::MatrixXd covariance =
      factor.solve(Eigen::MatrixXd::Identity(size, size).rightCols<kWatchCommon>());
  return covariance.block<6, 6>(size - kWatchCommon, 0).inverse();
}

}  // namespace handeye::test
