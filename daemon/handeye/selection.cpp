// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace handeye {
namespace {

struct Candidate {
  std::size_t i{0};
  std::size_t j{0};
  double angle_rad{0};       ///< of the hand
  double difference_rad{0};  ///< hand's against eye's
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
std::vector<std::size_t> thinned(std::span<const PosePair> poses, std::size_t max_poses) {
  std::vector<std::size_t> kept;
  const std::size_t step = std::max<std::size_t>(1, (poses.size() + max_poses - 1) / max_poses);
  for (std::size_t i = 0; i < poses.size(); i += step) {
    const PosePair& pair = poses[i];
    if (pair.room_from_hand.matrix().allFinite() && pair.eye_from_scene.matrix().allFinite()) {
      kept.push_back(i);
    }
  }
  return kept;
}

std::vector<Candidate> all_pairs(std::span<const PosePair> poses,
                                 const std::vector<std::size_t>& kept, double min_angle_rad) {
  const std::vector<Eigen::Vector3d> directions = axis_directions();
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t j = i + 1; j < kept.size(); ++j) {
      const auto [hand, eye] = movement_between(poses[kept[i]], poses[kept[j]]);
      const Eigen::Vector3d turn = log_so3(hand.linear());
      const double angle = turn.norm();
      if (angle < min_angle_rad) continue;
      candidates.push_back({i, j, angle, std::abs(angle - rotation_angle_rad(eye.linear())),
                            nearest_direction(directions, turn)});
    }
  }
  return candidates;
}

double median_difference_rad(std::vector<Candidate> candidates) {
  if (candidates.empty()) return 0;
  const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(candidates.size() / 2);
  std::nth_element(
      candidates.begin(), middle, candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.difference_rad < b.difference_rad; });
  return middle->difference_rad;
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
                              std::size_t max_movements) {
  std::array<std::vector<Candidate>, 13> bins;
  for (const Candidate& c : candidates) bins[c.direction].push_back(c);
  for (auto& bin : bins) {
    std::stable_sort(bin.begin(), bin.end(), [](const Candidate& a, const Candidate& b) {
      return a.angle_rad > b.angle_rad;
    });
  }
  const std::size_t max_uses = 1 + 4 * max_movements / std::max<std::size_t>(poses, 1);
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
  const std::vector<std::size_t> kept = thinned(poses, options.max_poses);
  std::vector<Candidate> candidates =
      all_pairs(poses, kept, rad_from_deg(options.lowest_min_angle_deg));
  const double tolerance_rad =
      std::max(rad_from_deg(options.min_tolerance_deg),
               options.tolerance_factor * median_difference_rad(candidates));
  std::erase_if(candidates, [&](const Candidate& c) { return c.difference_rad > tolerance_rad; });

  Selection selection;
  for (const Candidate& c :
       spread(in_window(candidates, options), kept.size(), options.max_movements)) {
    selection.movements.push_back(movement_between(poses[kept[c.i]], poses[kept[c.j]]));
    selection.pairs.push_back({kept[c.i], kept[c.j]});
  }
  return selection;
}

}  // namespace handeye
