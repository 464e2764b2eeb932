// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/window_adjuster.hpp"

#include <utility>

namespace handeye {
namespace {

/// Long enough for an adjustment (some 10 ms) even in a replay, where frames take a few ms each.
constexpr int kTakeOverAfterFrames = 5;

}  // namespace

WindowAdjuster::~WindowAdjuster() {
  if (under_way() && background_) thread_.wait();
}

void WindowAdjuster::begin(const CameraModel& camera, const AdjustmentOptions& options,
                           const Scene& scene) {
  wanted_again_ = under_way();
  if (under_way()) return;
  window_ = cut_window(camera, options, scene);
  frames_ = 0;
  if (background_) thread_.begin([this] { adjust(*window_); });
}

bool WindowAdjuster::count_frame() {
  return under_way() && ++frames_ >= kTakeOverAfterFrames;
}

AdjustmentWindow WindowAdjuster::take() {
  if (background_) {
    thread_.wait();
  } else {
    adjust(*window_);
  }
  AdjustmentWindow done = std::move(*window_);
  window_.reset();
  wanted_again_ = false;
  return done;
}

}  // namespace handeye
