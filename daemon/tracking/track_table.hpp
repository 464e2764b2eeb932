// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/tracking/bent_window.hpp"
#include "daemon/tracking/patch_alignment.hpp"

namespace handeye {

/// The features that are followed: a row each, a column a property, in the order of their ids. A
/// feature's life is its row's: born at the end, moved up as others before it end, gone for good
/// when lost. Positions at the working size. Capacity is fixed, and so is the memory.
class TrackTable {
 public:
  explicit TrackTable(std::size_t capacity);

  std::size_t size() const { return id.size(); }
  std::size_t room() const { return capacity_ - size(); }

  /// A row for a new feature: its appearance (to be filled) is at appearance_of(size() - 1).
  void add(std::int64_t feature_id, const Eigen::Vector2f& position, float corner_strength);

  /// Takes out the rows that are marked as lost.
  void drop_lost();

  Appearance& appearance_of(std::size_t row) { return appearances_[slot_[row]]; }
  const Appearance& appearance_of(std::size_t row) const { return appearances_[slot_[row]]; }

  std::vector<std::int64_t> id;
  std::vector<Eigen::Vector2f> pixel;
  std::vector<Eigen::Vector2f> velocity;        ///< px per second, of the last movement
  std::vector<int> age;                         ///< frames since it was found
  std::vector<float> strength;                  ///< as a corner, when it was found
  std::vector<AffineWarp> warp;                 ///< the appearance's patch in the last image
  std::vector<Eigen::Vector2f> anchor;          ///< the feature in the appearance's patch [px]
  std::vector<std::optional<WindowRays>> rays;  ///< of the appearance; none: the lens is not known
  std::vector<PatchFit> fit;                    ///< with the appearance, in the last image
  std::vector<std::uint8_t> lost;

 private:
  std::size_t capacity_;
  std::vector<std::size_t> slot_;  ///< of each row's appearance
  std::vector<std::size_t> free_slots_;
  std::vector<Appearance> appearances_;  ///< too large to be moved about
};

}  // namespace handeye
