// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/hand_smoothing.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "daemon/geometry/median.hpp"
#include "daemon/sync/hand_course.hpp"

namespace handeye {
namespace {

using Terms = Eigen::Vector4d;

constexpr std::size_t kFewestSamples = 6;    // four would be a line through all their noise
constexpr std::size_t kFewestWitnesses = 5;  // to judge another, which 60 Hz leave beside a flyer
/// What smooth hands do between samples is no jump, however little noise there is.
constexpr double kLeastUsual_rad = 1e-4;
constexpr double kLeastUsual_mm = 0.01;

Terms terms(double t) {
  return {1, t, t * t, t * t * t};
}

double square(double x) {
  return x * x;
}

/// As PoseBuffer's straight line has it.
SmoothedHand between_two(const HandLookup& found) {
  SmoothedHand hand{.room_from_hand = found.room_from_hand,
                    .angular_velocity = found.angular_velocity,
                    .velocity = found.velocity,
                    .sample = found.sample,
                    .shares = {1.0 - found.fraction},
                    .sample_covariance = found.sample_covariance};
  if (found.fraction > 0) hand.shares.push_back(found.fraction);
  return hand;
}

double sum_of_squares(const std::vector<double>& shares) {
  double sum = 0;
  for (const double share : shares) sum += share * share;
  return sum;
}

}  // namespace

HandSmoothing::HandSmoothing(const PoseBuffer& hand, const HandSmoothingOptions& options)
    : hand_(hand), options_(options), kinds_(hand.size(), Kind::kSmooth) {
  classify_samples();
}

std::optional<SmoothedHand> HandSmoothing::at(std::int64_t timestamp_ns) const {
  const HandLookup found = hand_.lookup(timestamp_ns);
  if (found.status != LookupStatus::kOk) return std::nullopt;
  SmoothedHand straight = between_two(found);
  const std::size_t before = hand_.index_of(found.sample);
  auto smoothed = fit(timestamp_ns, before, std::nullopt);
  if (!smoothed) return straight;
  const bool flies =
      kinds_[before] == Kind::kFlies || (found.fraction > 0 && kinds_[before + 1] == Kind::kFlies);
  // At the edges of what was seen a cubic may be worse than the line.
  if (!flies && sum_of_squares(smoothed->shares) >= sum_of_squares(straight.shares)) {
    return straight;
  }
  return smoothed;
}

/// Around an instant at or after sample `before`. Nothing where there are too few samples, or rough
/// ones among them. `without`: a sample that is to be judged by the others.
std::optional<SmoothedHand> HandSmoothing::fit(std::int64_t timestamp_ns, std::size_t before,
                                               std::optional<std::size_t> without) const {
  std::size_t low = before;
  std::size_t high = before;
  while (low > 0 && near(low - 1, timestamp_ns) && hand_.joined(low - 1)) --low;
  while (high + 1 < hand_.size() && near(high + 1, timestamp_ns) && hand_.joined(high)) ++high;

  const auto time_of = [&](std::size_t index) {
    return static_cast<double>(hand_.at(index).timestamp_ns - timestamp_ns) /
           static_cast<double>(options_.reach_ns);
  };
  std::size_t nearest = hand_.size();
  std::size_t samples = 0;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  for (std::size_t i = low; i <= high; ++i) {
    if (i == without) continue;
    if (kinds_[i] == Kind::kRough) return std::nullopt;
    if (kinds_[i] == Kind::kFlies) continue;
    const Terms row = terms(time_of(i));
    normal += row * row.transpose();
    ++samples;
    if (nearest == hand_.size() || std::abs(time_of(i)) < std::abs(time_of(nearest))) nearest = i;
  }
  if (samples < (without ? kFewestWitnesses : kFewestSamples)) return std::nullopt;
  const Eigen::Matrix4d inverse = normal.ldlt().solve(Eigen::Matrix4d::Identity());

  const Pose& base = hand_.at(nearest).room_from_hand;
  Vector6d moved = Vector6d::Zero();
  Vector6d rate = Vector6d::Zero();
  SmoothedHand hand{.sample = hand_.number_of(low)};
  Matrix6d covariance = Matrix6d::Zero();
  bool all_say = true;
  for (std::size_t i = low; i <= high; ++i) {
    const bool counts = kinds_[i] == Kind::kSmooth && i != without;
    const Eigen::Vector4d answers = inverse * terms(time_of(i));
    hand.shares.push_back(counts ? answers[0] : 0.0);
    if (!counts) continue;
    const Vector6d way = hand_movement(base, hand_.at(i).room_from_hand);
    moved += answers[0] * way;
    rate += answers[1] * 1e9 / static_cast<double>(options_.reach_ns) * way;
    all_say = all_say && hand_.at(i).covariance.has_value();
    if (all_say) covariance += square(answers[0]) * hand_.at(i).covariance->cast<double>();
  }
  hand.room_from_hand.linear() = exp_so3(moved.head<3>()) * base.linear();
  hand.room_from_hand.translation() = base.translation() + moved.tail<3>();
  hand.angular_velocity = hand.room_from_hand.linear().transpose() * rate.head<3>();
  hand.velocity = rate.tail<3>();
  if (all_say) hand.sample_covariance = covariance / sum_of_squares(hand.shares);
  return hand;
}

/// How far a sample is from where its neighbours have it, over how far is usual.
std::vector<double> HandSmoothing::excesses(Usual& usual) const {
  std::vector<Vector6d> off(hand_.size(), Vector6d::Zero());
  std::vector<double> rotations;
  std::vector<double> translations;
  for (std::size_t i = 0; i < hand_.size(); ++i) {
    if (!hand_.at(i).tracked) continue;
    const auto others = fit(hand_.at(i).timestamp_ns, i, i);
    if (!others) continue;
    off[i] = hand_movement(others->room_from_hand, hand_.at(i).room_from_hand);
    rotations.push_back(off[i].head<3>().norm());
    translations.push_back(off[i].tail<3>().norm());
  }
  // Of all samples: once is enough, and the first time is before any was left out.
  if (usual.rotation_rad == 0) {
    usual = {std::max(median(std::move(rotations)), kLeastUsual_rad),
             std::max(median(std::move(translations)), kLeastUsual_mm)};
  }
  std::vector<double> result;
  result.reserve(off.size());
  for (const Vector6d& by : off) {
    result.push_back(std::max(by.head<3>().norm() / usual.rotation_rad,
                              by.tail<3>().norm() / usual.translation_mm));
  }
  return result;
}

bool HandSmoothing::near(std::size_t index, std::int64_t timestamp_ns) const {
  return std::abs(hand_.at(index).timestamp_ns - timestamp_ns) <= options_.reach_ns;
}

/// The worst of its neighbourhood: it makes those around it look bad, too.
bool HandSmoothing::is_worst(std::size_t index, const std::vector<double>& excesses) const {
  const std::int64_t here_ns = hand_.at(index).timestamp_ns;
  for (std::size_t j = index; j-- > 0 && near(j, here_ns);) {
    if (excesses[j] >= excesses[index]) return false;
  }
  for (std::size_t j = index + 1; j < hand_.size() && near(j, here_ns); ++j) {
    if (excesses[j] > excesses[index]) return false;
  }
  return true;
}

void HandSmoothing::classify_samples() {
  Usual usual;
  std::vector<double> excess = excesses(usual);
  std::vector<std::size_t> flying;
  for (std::size_t i = 0; i < hand_.size(); ++i) {
    if (excess[i] <= options_.most_residual || !is_worst(i, excess)) continue;
    flying.push_back(i);
    kinds_[i] = Kind::kFlies;
  }
  if (flying.empty()) return;
  // Still off with the worst of them left out: no cubic goes through there.
  excess = excesses(usual);
  for (std::size_t i = 0; i < hand_.size(); ++i) {
    if (kinds_[i] == Kind::kSmooth && excess[i] > options_.most_residual) kinds_[i] = Kind::kRough;
  }
}

}  // namespace handeye
