// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_path.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace handeye {
namespace {

constexpr std::int64_t kKeepEvery_ns = 100'000'000;

}  // namespace

void HandPath::add(const HandSample& sample) {
  if (!sample.tracked) return;
  if (!poses_.empty() && sample.timestamp_ns - last_kept_ns_ < kKeepEvery_ns) return;
  last_kept_ns_ = sample.timestamp_ns;
  poses_.push_back(sample.room_from_hand);
  const Pose first_from_hand = poses_.front().inverse() * sample.room_from_hand;
  const Eigen::Vector3d w = log_so3(first_from_hand.linear());
  rotation_moment_ += w * w.transpose();
  rotation_coverage_deg_ = std::max(rotation_coverage_deg_, deg_from_rad(w.norm()));
  translation_coverage_mm_ =
      std::max(translation_coverage_mm_,
               (sample.room_from_hand.translation() - poses_.front().translation()).norm());
}

double HandPath::second_axis_deg() const {
  if (poses_.empty()) return 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      rotation_moment_ / static_cast<double>(poses_.size()), Eigen::EigenvaluesOnly);
  return deg_from_rad(std::sqrt(std::max(axes.eigenvalues()(1), 0.0)));
}

}  // namespace handeye
