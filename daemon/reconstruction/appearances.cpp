// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/appearances.hpp"

#include <algorithm>

namespace handeye {
namespace {

bool by_feature(const FeatureDescription& a, const FeatureDescription& b) {
  return a.feature_id < b.feature_id;
}

}  // namespace

void Appearances::update(const TrackedFrame& frame) {
  if (frame.observations.empty()) return;
  auto seen = frame.observations.begin();
  std::erase_if(living_, [&](const FeatureDescription& its) {
    while (seen != frame.observations.end() && seen->feature_id < its.feature_id) ++seen;
    return seen == frame.observations.end() || seen->feature_id != its.feature_id;
  });
  if (frame.descriptions.empty()) return;
  living_.insert(living_.end(), frame.descriptions.begin(), frame.descriptions.end());
  std::sort(living_.begin(), living_.end(), by_feature);
  told_ += static_cast<std::int64_t>(frame.descriptions.size());
}

const AppearanceBits* Appearances::find(std::int64_t feature_id) const {
  const auto found = std::lower_bound(living_.begin(), living_.end(),
                                      FeatureDescription{feature_id, {}}, by_feature);
  return found != living_.end() && found->feature_id == feature_id ? &found->bits : nullptr;
}

}  // namespace handeye
