// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/consensus.hpp"

#include <algorithm>

#include "daemon/handeye/explained.hpp"
#include "daemon/handeye/pairing.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

constexpr std::size_t kMinPoses = 4;  // of three, two against one would be a single movement

/// A movement that votes.
struct Ballot {
  std::size_t i{0};
  std::size_t j{0};
  ScrewPair screw;
};

bool comes_before(const Pose& a, const Pose& b) {
  const double* of_a = a.matrix().data();
  const double* of_b = b.matrix().data();
  return std::lexicographical_compare(of_a, of_a + a.matrix().size(), of_b,
                                      of_b + b.matrix().size());
}

/// By their numbers: which poses are compared must not depend on the order they are given in.
std::vector<std::size_t> usable_in_order(std::span<const PosePair> poses) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (are_usable(poses.subspan(i, 1))) usable.push_back(i);
  }
  std::sort(usable.begin(), usable.end(), [&](std::size_t i, std::size_t j) {
    const PosePair& a = poses[i];
    const PosePair& b = poses[j];
    if (comes_before(a.room_from_hand, b.room_from_hand)) return true;
    if (comes_before(b.room_from_hand, a.room_from_hand)) return false;
    return comes_before(a.eye_from_scene, b.eye_from_scene);
  });
  return usable;
}

std::vector<Ballot> ballots(std::span<const PosePair> poses, const ConsensusOptions& options) {
  const double min_angle_rad = rad_from_deg(options.min_angle_deg);
  std::vector<Ballot> result;
  for (const auto& [i, j] : spread_pairs(poses.size(), options.partners)) {
    const ScrewPair screw = screw_pair(movement_between(poses[i], poses[j]));
    if (std::max(screw.hand_angle_rad, screw.eye_angle_rad) < min_angle_rad) continue;
    result.push_back({i, j, screw});
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
  for (int round = 0; round < options.rounds; ++round) {
    right = vote(all, right, agreement, options);
    if (2 * count_of(right) < right.size()) return std::nullopt;
    // The wrong ones are gone: what is left is right, and tells the noise better.
    agreement = agreement_among(all, right, options.scale, 0.5).value_or(agreement);
  }
  return right;
}

/// By what a solution from those elected explains.
std::vector<bool> confirmed(std::span<const PosePair> poses, std::vector<bool> right,
                            const ConsensusOptions& options) {
  for (int round = 0; round < options.rounds; ++round) {
    auto now = explained_poses(poses, right, options.scale, options.pose_tolerance);
    if (!now) break;
    if (2 * count_of(*now) < right.size() || *now == right) break;
    right = std::move(*now);
  }
  return right;
}

}  // namespace

Consensus find_consensus(std::span<const PosePair> poses, const ConsensusOptions& options) {
  const std::vector<std::size_t> usable = usable_in_order(poses);
  std::vector<PosePair> sorted;
  sorted.reserve(usable.size());
  for (const std::size_t i : usable) sorted.push_back(poses[i]);

  const std::vector<Ballot> all = ballots(sorted, options);
  std::vector<bool> right(sorted.size(), true);
  auto agreement = agreement_among(all, right, options.scale, options.certainly_right);
  if (agreement && sorted.size() >= kMinPoses) {
    if (const auto majority = elected(all, right, *agreement, options)) {
      right = confirmed(sorted, *majority, options);
      agreement = agreement_among(all, right, options.scale, 0.5);
    }
  }

  std::vector<bool> is_wrong(poses.size(), true);
  for (std::size_t k = 0; k < usable.size(); ++k) is_wrong[usable[k]] = !right[k];
  Consensus consensus;
  consensus.agreement = agreement.value_or(ScrewAgreement{});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (is_wrong[i]) consensus.wrong.push_back(i);
  }
  return consensus;
}

std::vector<std::size_t> wrong_poses(std::span<const PosePair> poses,
                                     const ConsensusOptions& options) {
  return find_consensus(poses, options).wrong;
}

}  // namespace handeye
