// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/reconstruction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "daemon/reconstruction/adjustment_thread.hpp"
#include "daemon/reconstruction/appearances.hpp"
#include "daemon/reconstruction/segment.hpp"

namespace handeye {
namespace {

/// After a loss frames are looked for in the earlier parts only when so many features have been
/// described since the last attempt, or every so many frames: an attempt costs some milliseconds.
constexpr std::int64_t kNewlyDescribed = 20;
constexpr int kAttemptEvery = 10;
constexpr std::size_t kMostClosed = 8;

bool shows_nothing_new(ImageCondition condition) {
  return condition == ImageCondition::kDark || condition == ImageCondition::kFrozen;
}

/// Adds a part's frames, points and error to the whole; the frames behind those it has.
void add_part(Reconstruction part, int number, Reconstruction& whole) {
  const auto frames = static_cast<double>(whole.frames.size());
  const auto added = static_cast<double>(part.frames.size());
  whole.reprojection_px = std::sqrt((frames * whole.reprojection_px * whole.reprojection_px +
                                     added * part.reprojection_px * part.reprojection_px) /
                                    std::max(1.0, frames + added));
  whole.points += part.points;
  const int first = static_cast<int>(whole.frames.size());
  for (ScenePoint& point : part.structure) {
    point.part = number;
    for (ScenePoint::Observation& seen : point.observations) seen.frame += first;
    whole.structure.push_back(std::move(point));
  }
  for (RegisteredFrame& frame : part.frames) {
    frame.part = number;
    whole.frames.push_back(frame);
  }
}

/// Puts the frames of all parts in order of time.
void order_frames(Reconstruction& whole) {
  std::vector<int> order(whole.frames.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&whole](int a, int b) {
    return whole.frames[static_cast<std::size_t>(a)].index <
           whole.frames[static_cast<std::size_t>(b)].index;
  });
  std::vector<RegisteredFrame> frames;
  frames.reserve(order.size());
  std::vector<int> position(order.size());
  for (const int before : order) {
    position[static_cast<std::size_t>(before)] = static_cast<int>(frames.size());
    frames.push_back(whole.frames[static_cast<std::size_t>(before)]);
  }
  whole.frames = std::move(frames);
  for (ScenePoint& point : whole.structure) {
    for (ScenePoint::Observation& seen : point.observations) {
      seen.frame = position[static_cast<std::size_t>(seen.frame)];
    }
  }
}

}  // namespace

struct IncrementalReconstruction::Impl {
  Impl(const CameraModel& camera_model, const ReconstructionOptions& reconstruction_options)
      : camera(camera_model), options(reconstruction_options), active(begin_segment()) {}

  std::unique_ptr<Segment> begin_segment() {
    return std::make_unique<Segment>(camera, options, thread);
  }

  ReconstructionState add(const TrackedFrame& frame) {
    if (shows_nothing_new(frame.condition)) return last_state;
    appearances.update(frame);
    last_state = active->add(make_record(frame), appearances);
    ++state_counts[static_cast<std::size_t>(last_state)];
    if (active->lost()) {
      replace_active();
    } else if (!closed.empty() && !active->started()) {
      look_for_earlier_part();
    }
    return last_state;
  }

  /// The part in work has been lost; its unregistered rest begins the next.
  void replace_active() {
    active->settle();
    auto rest = active->take_lost_frames();
    if (active->started()) closed.push_back(std::move(active));
    forget_smallest();
    active = begin_segment();
    for (FrameRecord& frame : rest) active->add(std::move(frame), appearances);
    described_at_attempt = appearances.told();
    frames_since_attempt = 0;
  }

  void forget_smallest() {
    std::erase_if(closed, [this](const auto& part) {
      return part->registered_count() < options.min_part_frames;
    });
    if (closed.size() <= kMostClosed) return;
    closed.erase(std::min_element(closed.begin(), closed.end(), [](const auto& a, const auto& b) {
      return a->registered_count() < b->registered_count();
    }));
  }

  /// Where the newest frame shows an earlier part's scene, that part goes on.
  void look_for_earlier_part() {
    ++frames_since_attempt;
    if (appearances.told() < described_at_attempt + kNewlyDescribed &&
        frames_since_attempt < kAttemptEvery) {
      return;
    }
    described_at_attempt = appearances.told();
    frames_since_attempt = 0;
    for (auto part = closed.rbegin(); part != closed.rend(); ++part) {
      const auto found = (*part)->find(active->newest_frame(), appearances);
      if (!found) continue;
      (*part)->resume(active->take_all_frames(), *found, appearances);
      active = std::move(*part);
      closed.erase(std::next(part).base());
      last_state = ReconstructionState::kTracking;
      return;
    }
  }

  /// The parts worth keeping, the largest first.
  std::vector<Segment*> parts() const {
    std::vector<Segment*> kept;
    for (const auto& part : closed) kept.push_back(part.get());
    if (active->started()) kept.push_back(active.get());
    std::stable_sort(kept.begin(), kept.end(), [](const Segment* a, const Segment* b) {
      return a->registered_count() > b->registered_count();
    });
    if (kept.empty()) return kept;
    const double fewest = std::max<double>(options.min_part_frames,
                                           options.min_part_ratio * kept[0]->registered_count());
    kept.erase(
        std::remove_if(kept.begin() + 1, kept.end(),
                       [fewest](const Segment* part) { return part->registered_count() < fewest; }),
        kept.end());
    return kept;
  }

  /// What most frames suffered from, when nothing could be started or was worth keeping.
  ReconstructionState prevailing_state() const {
    static_assert(static_cast<int>(ReconstructionState::kTracking) == 3);
    const auto most = std::max_element(state_counts.begin(), state_counts.end() - 1);
    return static_cast<ReconstructionState>(most - state_counts.begin());
  }

  Reconstruction result() const {
    Reconstruction result;
    for (const Segment* part : parts()) add_part(part->result(), result.parts++, result);
    if (result.parts > 1) order_frames(result);
    result.state = result.parts > 0 ? ReconstructionState::kTracking : prevailing_state();
    result.lens.camera = camera;
    return result;
  }

  CameraModel camera;
  ReconstructionOptions options;
  Appearances appearances;
  AdjustmentThread thread;
  std::unique_ptr<Segment> active;
  std::vector<std::unique_ptr<Segment>> closed;  ///< in order of their loss
  ReconstructionState last_state{ReconstructionState::kTooFewFeatures};
  std::array<int, 4> state_counts{};
  std::int64_t described_at_attempt{0};
  int frames_since_attempt{0};
};

IncrementalReconstruction::IncrementalReconstruction(const CameraModel& camera,
                                                     const ReconstructionOptions& options)
    : impl_(std::make_unique<Impl>(camera, options)) {}

IncrementalReconstruction::~IncrementalReconstruction() = default;

ReconstructionState IncrementalReconstruction::add(const TrackedFrame& frame) {
  return impl_->add(frame);
}

Reconstruction IncrementalReconstruction::current() const {
  return impl_->result();
}

Reconstruction IncrementalReconstruction::finish() {
  for (Segment* part : impl_->parts()) part->finish();
  return impl_->result();
}

void IncrementalReconstruction::set_camera(const CameraModel& camera) {
  impl_->active->settle();
  impl_->camera = camera;
  impl_->active->refresh_rays();
  for (const auto& part : impl_->closed) part->refresh_rays();
}

int IncrementalReconstruction::keyframes() const {
  int count = impl_->active->keyframe_count();
  for (const auto& part : impl_->closed) count += part->keyframe_count();
  return count;
}

}  // namespace handeye
