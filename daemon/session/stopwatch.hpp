// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace handeye {

/// Wall time since construction; only ever reported, never part of a decision.
class Stopwatch {
 public:
  double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};

}  // namespace handeye
