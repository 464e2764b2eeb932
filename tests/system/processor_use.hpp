// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

namespace handeye::test {

/// Who has had the machine's processors since this was made, by /proc, in ticks of 10 ms. A test of
/// speed tells by it whether it was the program that was slow.
class ProcessorUse {
 public:
  /// Each in processors: 0 to how many there are.
  struct Shares {
    double own{0};     ///< this process and those it was made with
    double others{0};  ///< all else, the kernel's work and what a hypervisor kept included
    double idle{0};

    /// Whether others took something and nothing was left: then they made us wait.
    bool is_contended() const { return others > 0.25 && idle < 0.15; }
  };

  explicit ProcessorUse(std::vector<pid_t> own);
  Shares until_now() const;

 private:
  struct Ticks {
    double busy{0}, idle{0}, own{0};
  };
  Ticks now() const;

  std::vector<pid_t> own_;
  Ticks begun_;
};

/// "machine is busy: load 3.2, other processes took 1.4 of 2 processors".
std::string words(const ProcessorUse::Shares& shares);

}  // namespace handeye::test
