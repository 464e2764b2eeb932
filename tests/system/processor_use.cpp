// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/processor_use.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>

namespace handeye::test {
namespace {

/// Those it had, by proc(5); 0 for a process that is gone.
double ticks_of(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string text;
  std::getline(file, text);
  // The name, in brackets, may hold anything; utime and stime are 11 and 12 fields after it.
  std::istringstream after(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  std::string skipped;
  for (int field = 0; field < 11; ++field) after >> skipped;
  double user = 0;
  double system = 0;
  after >> user >> system;
  return user + system;
}

}  // namespace

ProcessorUse::ProcessorUse(std::vector<pid_t> own) : own_(std::move(own)) {
  own_.push_back(getpid());
  begun_ = now();
}

ProcessorUse::Ticks ProcessorUse::now() const {
  std::ifstream file("/proc/stat");
  std::string cpu;
  double user = 0, nice = 0, system = 0, idle = 0, io_wait = 0, irq = 0, soft_irq = 0, stolen = 0;
  file >> cpu >> user >> nice >> system >> idle >> io_wait >> irq >> soft_irq >> stolen;
  Ticks ticks{.busy = user + nice + system + irq + soft_irq + stolen, .idle = idle + io_wait};
  for (const pid_t process : own_) ticks.own += ticks_of(process);
  return ticks;
}

ProcessorUse::Shares ProcessorUse::until_now() const {
  const Ticks ended = now();
  const double own = ended.own - begun_.own;
  const double busy = std::max(ended.busy - begun_.busy, own);
  const double idle = ended.idle - begun_.idle;
  const double all = std::max(busy + idle, 1.0);
  const double processors = std::thread::hardware_concurrency();
  return {.own = processors * own / all,
          .others = processors * (busy - own) / all,
          .idle = processors * idle / all};
}

std::string words(const ProcessorUse::Shares& shares) {
  double load = 0;
  getloadavg(&load, 1);
  return fmt::format("machine is busy: load {:.1f}, other processes took {:.1f} of {} processors",
                     load, shares.others, std::thread::hardware_concurrency());
}

}  // namespace handeye::test
