// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/frame_record.hpp"

#include "daemon/geometry/median.hpp"
#include "daemon/geometry/projection.hpp"

namespace handeye {

FrameRecord make_record(const TrackedFrame& frame) {
  FrameRecord record;
  record.index = frame.index;
  record.timestamp_ns = frame.timestamp_ns;
  record.observations.reserve(frame.observations.size());
  for (const Observation& observation : frame.observations) {
    record.observations.push_back({observation.feature_id,
                                   static_cast<float>(observation.pixel.x()),
                                   static_cast<float>(observation.pixel.y())});
  }
  return record;
}

std::vector<PixelPair> common_features(const FrameRecord& first, const FrameRecord& second) {
  std::vector<PixelPair> pairs;
  auto a = first.observations.begin();
  auto b = second.observations.begin();
  while (a != first.observations.end() && b != second.observations.end()) {
    if (a->feature_id < b->feature_id) {
      ++a;
    } else if (b->feature_id < a->feature_id) {
      ++b;
    } else {
      pairs.push_back({{a->x, a->y}, {b->x, b->y}});
      ++a;
      ++b;
    }
  }
  return pairs;
}

double median_movement_px(const CameraModel& camera, const std::vector<PixelPair>& pairs) {
  std::vector<double> movements_px;
  movements_px.reserve(pairs.size());
  for (const PixelPair& pair : pairs) movements_px.push_back((pair.second - pair.first).norm());
  return median(std::move(movements_px)) * kReferenceFocalPx / focal_px(camera);
}

}  // namespace handeye
