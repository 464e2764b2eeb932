// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "drivers/dtrack/frame.hpp"
#include "drivers/dtrack/parse_report.hpp"

namespace handeye::dtrack {

/// Keeps the memory of lists that live inside a frame's elements while no element needs it.
template <typename List>
class ListPool {
 public:
  /// An empty list, with memory if there is any to be had. Take one only to put something in.
  List take() {
    if (spares_.empty()) {
      spares_.reserve(++lists_made_);  // so that giving it back will need no memory
      return {};
    }
    List list = std::move(spares_.back());
    spares_.pop_back();
    return list;
  }

  void give(List&& list) {
    if (list.capacity() == 0) return;
    list.clear();
    spares_.push_back(std::move(list));
  }

 private:
  std::vector<List> spares_;
  std::size_t lists_made_{0};
};

/// What a parser keeps from datagram to datagram: memory, never content.
struct LineMemory {
  ListPool<std::vector<bool>> buttons;
  ListPool<std::vector<double>> joysticks;
  ListPool<std::vector<Finger>> fingers;
  ListPool<std::vector<Joint>> joints;
  ListPool<std::vector<CameraStatus>> camera_status;
  std::vector<Body> hybrid_bodies;  ///< of line 6di, until they are merged with those of 6d
};

/// Takes back the lists of an element that is about to be destroyed; most have none.
template <typename Element>
void release(Element&, LineMemory&) {}
inline void release(Flystick& flystick, LineMemory& memory) {
  memory.buttons.give(std::move(flystick.buttons));
  memory.joysticks.give(std::move(flystick.joysticks));
}
inline void release(MeasurementTool& tool, LineMemory& memory) {
  memory.buttons.give(std::move(tool.buttons));
}
inline void release(FingertrackingHand& hand, LineMemory& memory) {
  memory.fingers.give(std::move(hand.fingers));
}
inline void release(HumanModel& human, LineMemory& memory) {
  memory.joints.give(std::move(human.joints));
}
inline void release(SystemStatus& status, LineMemory& memory) {
  memory.camera_status.give(std::move(status.camera_status));
}

/// What the readers of lines share while one datagram is parsed.
struct LineContext {
  Frame& frame;
  ParseCounters& counters;
  LineMemory& memory;
  std::uint32_t parts_seen{0};    ///< one bit a LineType::part that has been filled
  std::int32_t old_flysticks{0};  ///< devices of 6df: 6dcal counts them in
  std::int32_t old_tools{0};      ///< devices of 6dmt: likewise
};

/// Empties a frame, handing the memory of its nested lists to `memory`.
void reset(Frame& frame, LineMemory& memory);

}  // namespace handeye::dtrack
