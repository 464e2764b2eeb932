// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/consensus.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr std::size_t kMinPoses = 4;  // of three, two against one would be a single movement

/// A movement that votes.
struct Ballot {
  std::size_t i{0};
  std::size_t j{0};
  ScrewPair screw;
};

std::vector<std::size_t> finite_poses(std::span<const PosePair> poses) {
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (poses[i].room_from_hand.matrix().allFinite() &&
        poses[i].eye_from_scene.matrix().allFinite()) {
      finite.push_back(i);
    }
  }
  return finite;
}

/// How far apart compared poses are: one step from each stratum of 1..n/2, irregular within it lest
/// a periodic motion always meets itself.
std::vector<std::size_t> steps(std::size_t n, std::size_t partners) {
  const std::size_t half = n / 2;
  const std::size_t wanted = std::min(half, std::max<std::size_t>(1, partners / 2));
  constexpr double kGoldenRatio = 0.6180339887498949;
  std::vector<std::size_t> result;
  for (std::size_t m = 0; m < wanted; ++m) {
    const double within = std::fmod(static_cast<double>(m + 1) * kGoldenRatio, 1.0);
    const double stratum = static_cast<double>(half) / static_cast<double>(wanted);
    result.push_back(1 + static_cast<std::size_t>(stratum * (static_cast<double>(m) + within)));
    result.back() = std::min(result.back(), half);
  }
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Pose k with those `step` further on, round the sequence's end; each pair once.
std::vector<Ballot> ballots(std::span<const PosePair> poses, const std::vector<std::size_t>& finite,
                            const ConsensusOptions& options) {
  const std::size_t n = finite.size();
  const double min_angle_rad = rad_from_deg(options.min_angle_deg);
  std::vector<Ballot> result;
  for (const std::size_t step : steps(n, options.partners)) {
    const std::size_t starts = 2 * step == n ? step : n;
    for (std::size_t k = 0; k < starts; ++k) {
      const std::size_t other = (k + step) % n;
      const std::size_t i = finite[std::min(k, other)];
      const std::size_t j = finite[std::max(k, other)];
      const ScrewPair screw = screw_pair(movement_between(poses[i], poses[j]));
      if (std::max(screw.hand_angle_rad, screw.eye_angle_rad) < min_angle_rad) continue;
      result.push_back({i, j, screw});
    }
  }
  return result;
}

/// What the movements between right poses say of scale and noise.
std::optional<ScrewAgreement> agreement_among(const std::vector<Ballot>& ballots,
                                              const std::vector<bool>& right, ScaleMode scale,
                                              double quantile) {
  std::vector<ScrewPair> screws;
  for (const Ballot& b : ballots) {
    if (right[b.i] && right[b.j]) screws.push_back(b.screw);
  }
  return screw_agreement(screws, scale, quantile);
}

/// Each pose's share of agreeing movements to right poses, against the share that is wanted.
std::vector<bool> vote(const std::vector<Ballot>& ballots, const std::vector<bool>& right,
                       const ScrewAgreement& agreement, const ConsensusOptions& options) {
  const std::size_t n = right.size();
  std::vector<std::size_t> agreeing(n, 0);
  std::vector<std::size_t> judged(n, 0);
  const auto count = [&](std::size_t pose, std::size_t partner, bool agrees) {
    if (!right[partner]) return;
    ++judged[pose];
    if (agrees) ++agreeing[pose];
  };
  for (const Ballot& b : ballots) {
    if (!agreement.can_judge(b.screw, 0)) continue;
    const bool agrees = agreement.agrees(b.screw, options.tolerance);
    count(b.i, b.j, agrees);
    count(b.j, b.i, agrees);
  }
  std::vector<bool> now_right(n);
  for (std::size_t i = 0; i < n; ++i) {
    now_right[i] = static_cast<double>(agreeing[i]) >=
                   options.right_from_share * static_cast<double>(judged[i]);
  }
  return now_right;
}

}  // namespace

Consensus find_consensus(std::span<const PosePair> poses, const ConsensusOptions& options) {
  const std::vector<std::size_t> finite = finite_poses(poses);
  std::vector<bool> is_finite(poses.size(), false);
  for (const std::size_t i : finite) is_finite[i] = true;

  const std::vector<Ballot> all = ballots(poses, finite, options);
  const auto first = agreement_among(all, is_finite, options.scale, options.certainly_right)
                         .value_or(ScrewAgreement{});
  std::vector<bool> right = is_finite;
  Consensus consensus{{}, first};
  for (int round = 0; round < options.rounds && finite.size() >= kMinPoses; ++round) {
    right = vote(all, right, consensus.agreement, options);
    for (std::size_t i = 0; i < right.size(); ++i) right[i] = right[i] && is_finite[i];
    const auto left = static_cast<std::size_t>(std::count(right.begin(), right.end(), true));
    if (2 * left < finite.size()) {
      right = is_finite;
      consensus.agreement = first;
      break;
    }
    // The wrong ones are gone: what is left is right, and tells the noise better.
    consensus.agreement =
        agreement_among(all, right, options.scale, 0.5).value_or(consensus.agreement);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!right[i]) consensus.wrong.push_back(i);
  }
  return consensus;
}

std::vector<std::size_t> wrong_poses(std::span<const PosePair> poses,
                                     const ConsensusOptions& options) {
  return find_consensus(poses, options).wrong;
}

}  // namespace handeye
