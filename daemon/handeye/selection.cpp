// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/handeye/consensus.hpp"

namespace handeye {
namespace {

struct Candidate {
  std::size_t i{0};
  std::size_t j{0};
  double angle_rad{0};       ///< of the hand
  std::size_t direction{0};  ///< of the axis
};

/// Thirteen axes: along the edges, face diagonals and space diagonals of a cube.
std::vector<Eigen::Vector3d> axis_directions() {
  std::vector<Eigen::Vector3d> directions;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x * 9 + y * 3 + z > 0) directions.push_back(Eigen::Vector3d(x, y, z).normalized());
      }
    }
  }
  return directions;
}

std::size_t nearest_direction(const std::vector<Eigen::Vector3d>& directions,
                              const Eigen::Vector3d& axis) {
  const auto nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::abs(a.dot(axis)) < std::abs(b.dot(axis));
  };
  const auto best = std::max_element(directions.begin(), directions.end(), nearer);
  return static_cast<std::size_t>(best - directions.begin());
}

/// Indices of the poses that are looked at.
std::vector<std::size_t> thinned(std::size_t poses, std::size_t max_poses) {
  std::vector<std::size_t> kept;
  const std::size_t step = std::max<std::size_t>(1, (poses + max_poses - 1) / max_poses);
  for (std::size_t i = 0; i < poses; i += step) kept.push_back(i);
  return kept;
}

/// All movements between right poses that hand and eye see alike.
std::vector<Candidate> all_pairs(std::span<const PosePair> poses,
                                 const std::vector<std::size_t>& right,
                                 const ScrewAgreement& agreement, const SelectionOptions& options) {
  const std::vector<Eigen::Vector3d> directions = axis_directions();
  const double min_angle_rad = rad_from_deg(options.lowest_min_angle_deg);
  std::vector<Candidate> candidates;
  for (const std::size_t i : right) {
    for (const std::size_t j : right) {
      if (j <= i) continue;
      const Movement movement = movement_between(poses[i], poses[j]);
      const ScrewPair screw = screw_pair(movement);
      if (screw.hand_angle_rad < min_angle_rad || !agreement.agrees(screw, options.tolerance)) {
        continue;
      }
      candidates.push_back(
          {i, j, screw.hand_angle_rad,
           nearest_direction(directions, log_so3(movement.hand_j_from_hand_i.linear()))});
    }
  }
  return candidates;
}

/// The angle window: at least the smallest angle, halved until there are enough; not near 180
/// degrees unless nothing else is there.
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
  while (kept.size() < options.enough && min_angle_deg > options.lowest_min_angle_deg) {
    min_angle_deg = std::max(0.5 * min_angle_deg, options.lowest_min_angle_deg);
    kept = between(min_angle_deg, options.max_angle_deg);
  }
  return kept.size() >= 2 ? kept : between(min_angle_deg, 180.0);
}

/// Direction by direction in turn, each the largest angle left whose poses are not yet worn out.
std::vector<Candidate> spread(const std::vector<Candidate>& candidates, std::size_t poses,
                              std::size_t right, std::size_t max_movements) {
  std::array<std::vector<Candidate>, 13> bins;
  for (const Candidate& c : candidates) bins[c.direction].push_back(c);
  for (auto& bin : bins) {
    std::stable_sort(bin.begin(), bin.end(), [](const Candidate& a, const Candidate& b) {
      return a.angle_rad > b.angle_rad;
    });
  }
  const std::size_t max_uses = 1 + 4 * max_movements / std::max<std::size_t>(right, 1);
  std::vector<std::size_t> uses(poses, 0);
  std::array<std::size_t, 13> next{};
  std::vector<Candidate> chosen;
  for (bool any = true; any && chosen.size() < max_movements;) {
    any = false;
    for (std::size_t b = 0; b < bins.size() && chosen.size() < max_movements; ++b) {
      while (next[b] < bins[b].size()) {
        const Candidate& c = bins[b][next[b]++];
        if (uses[c.i] >= max_uses || uses[c.j] >= max_uses) continue;
        ++uses[c.i];
        ++uses[c.j];
        chosen.push_back(c);
        any = true;
        break;
      }
    }
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
  const std::vector<Candidate> candidates = all_pairs(poses, kept, consensus.agreement, options);
  for (const Candidate& c :
       spread(in_window(candidates, options), poses.size(), kept.size(), options.max_movements)) {
    selection.movements.push_back(movement_between(poses[c.i], poses[c.j]));
    selection.pairs.push_back({c.i, c.j});
  }
  return selection;
}

}  // namespace handeye
