// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/reconstruction/frame_record.hpp"

namespace handeye {

/// The frames of a part in order of time, with what memory allows of what they show: a frame that
/// is settled has given up its observations and keeps its pose relative to the frames around it.
class FrameHistory {
 public:
  using Frames = std::vector<FrameRecord>;

  FrameRecord& append(FrameRecord frame);

  /// Takes the last `count` frames away.
  Frames take_last(int count);

  /// Gives up the first `count` frames.
  void drop_first(int count);

  /// Above `most` frames with observations settles every second of the older ones.
  void bound_memory(int most);

  /// Where the newest frame is if the last two with a pose before it are gone on from steadily.
  Pose predict_newest() const;

  /// nullptr: no such frame.
  FrameRecord* find(std::int64_t index);
  const FrameRecord* find(std::int64_t index) const;

  Frames& all() { return frames_; }
  const Frames& all() const { return frames_; }
  FrameRecord& newest() { return frames_.back(); }
  const FrameRecord& newest() const { return frames_.back(); }
  int count() const { return static_cast<int>(frames_.size()); }

 private:
  Frames frames_;
  int observed_{0};  ///< frames that still have their observations
};

/// Whether the frame has a pose but no longer its observations.
bool is_settled(const FrameRecord& frame);

}  // namespace handeye
