// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/parallel_loop.hpp"

#include <algorithm>

namespace handeye {
namespace {

/// Passes taken at a time: few enough that the threads end together.
constexpr std::size_t kAtATime = 8;

}  // namespace

ParallelLoop::ParallelLoop(int threads) {
  for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { help(); });
}

ParallelLoop::~ParallelLoop() {
  ending_ = true;
  ++round_;
  round_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ParallelLoop::run_erased(std::size_t count, void* callable, Call call) {
  count_ = count;
  callable_ = callable;
  call_ = call;
  next_ = 0;
  // A loop that one thread finishes at a stroke is not worth waking anybody for.
  const bool alone = helpers_.empty() || count <= kAtATime;
  if (!alone) {
    inside_ = kOpen;
    ++round_;
    round_.notify_all();
  }
  work();
  if (alone) return;
  // All passes are taken. Those who took some are waited for; nobody else comes in.
  inside_ &= ~kOpen;
  for (std::uint32_t inside = inside_; inside != 0; inside = inside_) inside_.wait(inside);
}

bool ParallelLoop::enter() {
  std::uint32_t inside = inside_;
  while ((inside & kOpen) != 0) {
    if (inside_.compare_exchange_weak(inside, inside + 1)) return true;
  }
  return false;
}

void ParallelLoop::leave() {
  if (--inside_ == 0) inside_.notify_one();
}

void ParallelLoop::work() {
  for (;;) {
    const std::size_t first = next_.fetch_add(kAtATime);
    if (first >= count_) return;
    const std::size_t last = std::min(first + kAtATime, count_);
    for (std::size_t i = first; i < last; ++i) call_(callable_, i);
  }
}

void ParallelLoop::help() {
  std::uint32_t seen = 0;
  for (;;) {
    round_.wait(seen);
    seen = round_;
    if (ending_) return;
    if (!enter()) continue;
    work();
    leave();
  }
}

}  // namespace handeye
