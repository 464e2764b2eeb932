// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/track_table.hpp"

namespace handeye {
namespace {

/// Keeps the rows that are not lost, in order.
template <typename Column>
void compact(Column& column, const std::vector<std::uint8_t>& lost) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < lost.size(); ++row) {
    if (lost[row] == 0) column[kept++] = column[row];
  }
  column.resize(kept);
}

}  // namespace

TrackTable::TrackTable(std::size_t capacity) : capacity_(capacity), appearances_(capacity) {
  id.reserve(capacity);
  pixel.reserve(capacity);
  velocity.reserve(capacity);
  age.reserve(capacity);
  strength.reserve(capacity);
  warp.reserve(capacity);
  anchor.reserve(capacity);
  rays.reserve(capacity);
  fit.reserve(capacity);
  lost.reserve(capacity);
  slot_.reserve(capacity);
  free_slots_.reserve(capacity);
  for (std::size_t slot = capacity; slot > 0; --slot) free_slots_.push_back(slot - 1);
}

void TrackTable::add(std::int64_t feature_id, const Eigen::Vector2f& position,
                     float corner_strength) {
  id.push_back(feature_id);
  pixel.push_back(position);
  velocity.emplace_back(Eigen::Vector2f::Zero());
  age.push_back(0);
  strength.push_back(corner_strength);
  warp.push_back({position, Eigen::Matrix2f::Identity()});
  anchor.emplace_back(Eigen::Vector2f::Zero());
  rays.emplace_back();
  fit.push_back({.found = true, .correlation = 1});
  lost.push_back(0);
  slot_.push_back(free_slots_.back());
  free_slots_.pop_back();
}

void TrackTable::drop_lost() {
  for (std::size_t row = 0; row < size(); ++row) {
    if (lost[row] != 0) free_slots_.push_back(slot_[row]);
  }
  compact(id, lost);
  compact(pixel, lost);
  compact(velocity, lost);
  compact(age, lost);
  compact(strength, lost);
  compact(warp, lost);
  compact(anchor, lost);
  compact(rays, lost);
  compact(fit, lost);
  compact(slot_, lost);
  lost.assign(id.size(), 0);
}

}  // namespace handeye
