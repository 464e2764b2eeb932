// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/frame_history.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace handeye {
namespace {

/// Settling goes through all frames: it is done for many at once.
constexpr int kSlack = 200;
/// The newest frames are left alone: adjustments still move them.
constexpr int kUntouched = 200;
/// A steady motion is not gone on with for longer than this, in multiples of the last interval.
constexpr double kMostAhead = 3.0;

}  // namespace

bool is_settled(const FrameRecord& frame) {
  return frame.eye_from_scene && frame.observations.empty();
}

FrameRecord& FrameHistory::append(FrameRecord frame) {
  frames_.push_back(std::move(frame));
  ++observed_;
  return frames_.back();
}

FrameHistory::Frames FrameHistory::take_last(int count) {
  const auto first = frames_.end() - std::min(count, this->count());
  Frames taken(std::make_move_iterator(first), std::make_move_iterator(frames_.end()));
  frames_.erase(first, frames_.end());
  observed_ -= static_cast<int>(taken.size());
  return taken;
}

void FrameHistory::drop_first(int count) {
  frames_.erase(frames_.begin(), frames_.begin() + std::min(count, this->count()));
  observed_ = this->count();
}

void FrameHistory::bound_memory(int most) {
  if (observed_ <= most + kSlack) return;
  const int wanted = observed_ - most;
  int settled = 0;
  bool second = false;
  for (int i = 0; i < count() - kUntouched && settled < wanted; ++i) {
    FrameRecord& frame = frames_[static_cast<std::size_t>(i)];
    if (frame.keyframe || !frame.eye_from_scene || is_settled(frame)) continue;
    if (second) {
      std::vector<FrameObservation>().swap(frame.observations);
      ++settled;
    }
    second = !second;
  }
  observed_ -= settled;
}

Pose FrameHistory::predict_newest() const {
  const FrameRecord* last = nullptr;
  for (auto frame = frames_.rbegin() + 1; frame != frames_.rend(); ++frame) {
    if (!frame->eye_from_scene) continue;
    if (last == nullptr) {
      last = &*frame;
      continue;
    }
    const double ahead = static_cast<double>(newest().index - frame->index) /
                         static_cast<double>(last->index - frame->index);
    return interpolate(*frame->eye_from_scene, *last->eye_from_scene, std::min(ahead, kMostAhead));
  }
  return last != nullptr ? *last->eye_from_scene : Pose::Identity();
}

const FrameRecord* FrameHistory::find(std::int64_t index) const {
  const auto found = std::lower_bound(
      frames_.begin(), frames_.end(), index,
      [](const FrameRecord& frame, std::int64_t wanted) { return frame.index < wanted; });
  return found != frames_.end() && found->index == index ? &*found : nullptr;
}

FrameRecord* FrameHistory::find(std::int64_t index) {
  const FrameRecord* found = std::as_const(*this).find(index);
  return found != nullptr ? &frames_[static_cast<std::size_t>(found - frames_.data())] : nullptr;
}

}  // namespace handeye
