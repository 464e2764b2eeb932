// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/selection.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "daemon/handeye/consensus.hpp"
#include "daemon/handeye/pairing.hpp"
#include "daemon/handeye/vector_quantisation.hpp"

namespace handeye {
namespace {

struct Candidate {
  std::size_t i{0};
  std::size_t j{0};
  double angle_rad{0};                            ///< of the hand
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};  ///< rotation vector of the hand
};

/// Indices of the poses that are looked at, evenly over all.
std::vector<std::size_t> thinned(std::size_t poses, std::size_t max_poses) {
  const std::size_t wanted = std::min(poses, max_poses);
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < wanted; ++k) kept.push_back(k * poses / wanted);
  return kept;
}

/// Movements between right poses that hand and eye see alike.
std::vector<Candidate> agreeing_pairs(std::span<const PosePair> poses,
                                      const std::vector<std::size_t>& right,
                                      const ScrewAgreement& agreement,
                                      const SelectionOptions& options) {
  const double min_angle_rad = rad_from_deg(options.lowest_min_angle_deg);
  const std::size_t partners = 2 * options.max_candidates / std::max<std::size_t>(right.size(), 1);
  std::vector<Candidate> candidates;
  for (const auto& [a, b] : spread_pairs(right.size(), partners)) {
    const Movement movement = movement_between(poses[right[a]], poses[right[b]]);
    const ScrewPair screw = screw_pair(movement);
    if (screw.hand_angle_rad < min_angle_rad || !agreement.agrees(screw, options.tolerance)) {
      continue;
    }
    candidates.push_back(
        {right[a], right[b], screw.hand_angle_rad, log_so3(movement.hand_j_from_hand_i.linear())});
  }
  return candidates;
}

/// The angle window. When there are not enough it is opened to 180 degrees first: near it an axis
/// is ambiguous, but a large turn says more than any small one. Then the smallest angle is halved
/// until there are enough.
std::vector<Candidate> in_window(const std::vector<Candidate>& candidates,
                                 const SelectionOptions& options) {
  const auto between = [&](double min_deg, double max_deg) {
    std::vector<Candidate> kept;
    for (const Candidate& c : candidates) {
      const double angle_deg = deg_from_rad(c.angle_rad);
      if (angle_deg >= min_deg && angle_deg <= max_deg) kept.push_back(c);
    }
    return kept;
  };
  double min_angle_deg = options.min_angle_deg;
  std::vector<Candidate> kept = between(min_angle_deg, options.max_angle_deg);
  if (kept.size() < options.enough) kept = between(min_angle_deg, 180.0);
  while (kept.size() < options.enough && min_angle_deg > options.lowest_min_angle_deg) {
    min_angle_deg = std::max(0.5 * min_angle_deg, options.lowest_min_angle_deg);
    kept = between(min_angle_deg, 180.0);
  }
  return kept;
}

/// Rotation vectors of one half-space, about whose axis they turn most: -w is the same movement
/// reversed.
std::vector<Eigen::Vector3d> folded_turns(const std::vector<Candidate>& candidates) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Candidate& c : candidates) scatter += c.turn * c.turn.transpose();
  const Eigen::Vector3d main_axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(2);
  std::vector<Eigen::Vector3d> turns;
  turns.reserve(candidates.size());
  for (const Candidate& c : candidates) {
    turns.push_back(c.turn.dot(main_axis) < 0 ? Eigen::Vector3d(-c.turn) : c.turn);
  }
  return turns;
}

/// One movement of each cell of rotation vectors: between the poses least used so far, of those the
/// nearest to the cell's centre.
std::vector<Candidate> representatives(const std::vector<Candidate>& candidates, std::size_t poses,
                                       std::size_t max_movements) {
  const std::vector<Eigen::Vector3d> turns = folded_turns(candidates);
  std::vector<std::size_t> uses(poses, 0);
  std::vector<Candidate> chosen;
  for (const Cell& cell : quantise(turns, max_movements)) {
    const auto better = [&](std::size_t a, std::size_t b) {
      const std::size_t uses_a = uses[candidates[a].i] + uses[candidates[a].j];
      const std::size_t uses_b = uses[candidates[b].i] + uses[candidates[b].j];
      if (uses_a != uses_b) return uses_a < uses_b;
      return (turns[a] - cell.centre).squaredNorm() < (turns[b] - cell.centre).squaredNorm();
    };
    const std::size_t best = *std::min_element(cell.members.begin(), cell.members.end(), better);
    ++uses[candidates[best].i];
    ++uses[candidates[best].j];
    chosen.push_back(candidates[best]);
  }
  return chosen;
}

}  // namespace

Selection select_movements(std::span<const PosePair> poses, const SelectionOptions& options) {
  std::vector<std::size_t> kept = thinned(poses.size(), options.max_poses);
  std::vector<PosePair> looked_at;
  for (const std::size_t i : kept) looked_at.push_back(poses[i]);
  const Consensus consensus = find_consensus(looked_at, {.scale = options.scale});

  Selection selection;
  for (const std::size_t i : consensus.wrong) selection.wrong_poses.push_back(kept[i]);
  std::erase_if(kept, [&](std::size_t i) {
    return std::binary_search(selection.wrong_poses.begin(), selection.wrong_poses.end(), i);
  });
  const std::vector<Candidate> candidates =
      in_window(agreeing_pairs(poses, kept, consensus.agreement, options), options);
  for (const Candidate& c : representatives(candidates, poses.size(), options.max_movements)) {
    selection.movements.push_back(movement_between(poses[c.i], poses[c.j]));
    selection.pairs.push_back({c.i, c.j});
  }
  return selection;
}

}  // namespace handeye
