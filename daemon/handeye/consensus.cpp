// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/consensus.hpp"

#include <algorithm>

#include "daemon/handeye/explained.hpp"
#include "daemon/handeye/pairing.hpp"

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

std::vector<Ballot> ballots(std::span<const PosePair> poses, const std::vector<std::size_t>& finite,
                            const ConsensusOptions& options) {
  const double min_angle_rad = rad_from_deg(options.min_angle_deg);
  std::vector<Ballot> result;
  for (const auto& [a, b] : spread_pairs(finite.size(), options.partners)) {
    const ScrewPair screw = screw_pair(movement_between(poses[finite[a]], poses[finite[b]]));
    if (std::max(screw.hand_angle_rad, screw.eye_angle_rad) < min_angle_rad) continue;
    result.push_back({finite[a], finite[b], screw});
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

std::size_t count_of(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), true));
}

/// By vote of the movements, whatever X is. Nothing when there is no majority.
std::optional<std::vector<bool>> elected(const std::vector<Ballot>& all, std::vector<bool> right,
                                         ScrewAgreement agreement,
                                         const ConsensusOptions& options) {
  const std::vector<bool> allowed = right;
  for (int round = 0; round < options.rounds; ++round) {
    right = vote(all, right, agreement, options);
    for (std::size_t i = 0; i < right.size(); ++i) right[i] = right[i] && allowed[i];
    if (2 * count_of(right) < count_of(allowed)) return std::nullopt;
    // The wrong ones are gone: what is left is right, and tells the noise better.
    agreement = agreement_among(all, right, options.scale, 0.5).value_or(agreement);
  }
  return right;
}

/// By what a solution from those elected explains.
std::vector<bool> confirmed(std::span<const PosePair> poses, std::vector<bool> right,
                            const std::vector<bool>& allowed, const ConsensusOptions& options) {
  for (int round = 0; round < options.rounds; ++round) {
    auto now = explained_poses(poses, right, options.scale, options.pose_tolerance);
    if (!now) break;
    for (std::size_t i = 0; i < right.size(); ++i) (*now)[i] = (*now)[i] && allowed[i];
    if (2 * count_of(*now) < count_of(allowed) || *now == right) break;
    right = std::move(*now);
  }
  return right;
}

}  // namespace

Consensus find_consensus(std::span<const PosePair> poses, const ConsensusOptions& options) {
  const std::vector<std::size_t> finite = finite_poses(poses);
  std::vector<bool> allowed(poses.size(), false);
  for (const std::size_t i : finite) allowed[i] = true;

  const std::vector<Ballot> all = ballots(poses, finite, options);
  std::vector<bool> right = allowed;
  auto agreement = agreement_among(all, right, options.scale, options.certainly_right);
  if (agreement && finite.size() >= kMinPoses) {
    if (const auto majority = elected(all, right, *agreement, options)) {
      right = confirmed(poses, *majority, allowed, options);
      agreement = agreement_among(all, right, options.scale, 0.5);
    }
  }
  Consensus consensus;
  consensus.agreement = agreement.value_or(ScrewAgreement{});
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
