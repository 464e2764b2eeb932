// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/reconstruction.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "daemon/reconstruction/segment.hpp"

namespace handeye {

struct IncrementalReconstruction::Impl {
  Impl(const CameraModel& camera_model, const ReconstructionOptions& reconstruction_options)
      : camera(camera_model), options(reconstruction_options), active(begin_segment()) {}

  std::unique_ptr<Segment> begin_segment() const {
    return std::make_unique<Segment>(camera, options);
  }

  /// The part in work is over: it is kept if it is the largest so far, and its unregistered rest
  /// begins the next.
  void replace_active() {
    auto rest = active->take_lost_frames();
    if (active->started()) {
      closed_keyframes += active->keyframe_count();
      if (!largest_closed || active->registered_count() > largest_closed->registered_count()) {
        largest_closed = std::move(active);
      }
    }
    active = begin_segment();
    for (FrameRecord& frame : rest) active->add(std::move(frame));
  }

  Segment& largest() const {
    const bool closed =
        largest_closed &&
        (!active->started() || largest_closed->registered_count() >= active->registered_count());
    return closed ? *largest_closed : *active;
  }

  /// What most frames suffered from, when nothing could be started.
  ReconstructionState prevailing_state() const {
    const auto most = std::max_element(state_counts.begin(), state_counts.end());
    return static_cast<ReconstructionState>(most - state_counts.begin());
  }

  Reconstruction result() const {
    Reconstruction result = largest().result();
    if (result.state != ReconstructionState::kTracking) result.state = prevailing_state();
    result.lens.camera = camera;
    return result;
  }

  CameraModel camera;
  ReconstructionOptions options;
  std::unique_ptr<Segment> active;
  std::unique_ptr<Segment> largest_closed;
  int closed_keyframes{0};
  std::array<int, 4> state_counts{};
};

IncrementalReconstruction::IncrementalReconstruction(const CameraModel& camera,
                                                     const ReconstructionOptions& options)
    : impl_(std::make_unique<Impl>(camera, options)) {}

IncrementalReconstruction::~IncrementalReconstruction() = default;

ReconstructionState IncrementalReconstruction::add(const TrackedFrame& frame) {
  const ReconstructionState state = impl_->active->add(make_record(frame));
  ++impl_->state_counts[static_cast<std::size_t>(state)];
  if (impl_->active->lost()) impl_->replace_active();
  return state;
}

Reconstruction IncrementalReconstruction::current() const {
  return impl_->result();
}

Reconstruction IncrementalReconstruction::finish() {
  impl_->largest().finish();
  return impl_->result();
}

void IncrementalReconstruction::set_camera(const CameraModel& camera) {
  impl_->camera = camera;
  impl_->active->refresh_rays();
  if (impl_->largest_closed) impl_->largest_closed->refresh_rays();
}

int IncrementalReconstruction::keyframes() const {
  return impl_->closed_keyframes + impl_->active->keyframe_count();
}

}  // namespace handeye
