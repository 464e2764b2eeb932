// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <vector>

namespace handeye {

/// Runs the passes of a loop on the calling thread and some helpers that live as long as it does.
/// Which thread runs which pass is left to chance: passes must not depend on each other. A loop
/// ends when its passes are done: a helper that the scheduler has not woken meanwhile is not waited
/// for. Starting a loop allocates nothing.
class ParallelLoop {
 public:
  /// `threads`: the calling one included.
  explicit ParallelLoop(int threads);
  ParallelLoop(const ParallelLoop&) = delete;
  ParallelLoop& operator=(const ParallelLoop&) = delete;
  ~ParallelLoop();

  /// Calls pass(i) for every i in [0, count); returns when all are done. `pass` must not throw.
  template <typename Pass>
  void run(std::size_t count, Pass&& pass) {
    using Callable = std::remove_reference_t<Pass>;
    run_erased(count, const_cast<std::remove_const_t<Callable>*>(&pass),
               [](void* callable, std::size_t i) { (*static_cast<Callable*>(callable))(i); });
  }

 private:
  static constexpr std::uint32_t kOpen = 1U << 31;

  using Call = void (*)(void* callable, std::size_t i);

  void run_erased(std::size_t count, void* callable, Call call);
  void work();
  void help();
  bool enter();
  void leave();

  // Of the loop that runs; written while no helper is in it.
  std::size_t count_{0};
  void* callable_{nullptr};
  Call call_{nullptr};
  std::atomic<std::size_t> next_{0};

  std::atomic<std::uint32_t> round_{0};  ///< raised at each loop, and once more to end
  /// Helpers that are in the loop, and kOpen as long as others may enter.
  std::atomic<std::uint32_t> inside_{0};
  std::atomic<bool> ending_{false};
  std::vector<std::thread> helpers_;
};

}  // namespace handeye
