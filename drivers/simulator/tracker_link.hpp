// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulator/tracker_device.hpp"

namespace handeye::simulator {

/// The way of a tracker's datagrams to us, which may lose, hold back, reorder and duplicate them as
/// the world's faults say. Without faults they come as the device sends them. The world must
/// outlive it.
class TrackerLink {
 public:
  explicit TrackerLink(const World& world);

  /// The next datagram that arrives, in order of arrival; its memory is reused.
  void next(SimulatedDatagram& datagram);

 private:
  struct Pending {
    std::int64_t arrival_ns{0};
    std::uint64_t order{0};  ///< of those that arrive at the same instant
    SimulatedDatagram datagram;
    bool later_than(const Pending& other) const {
      return arrival_ns != other.arrival_ns ? arrival_ns > other.arrival_ns : order > other.order;
    }
  };

  void send();
  void deliver(std::int64_t arrival_ns);
  std::int64_t held_until_ns(std::int64_t arrival_ns) const;

  const World* world_;
  TrackerDevice device_;
  std::uint64_t count_{0};
  std::uint64_t order_{0};
  std::int64_t sent_until_ns_{0};  ///< all arrivals before this are among the pending
  SimulatedDatagram sent_;
  std::vector<Pending> pending_;  ///< a heap, the earliest first
};

}  // namespace handeye::simulator
