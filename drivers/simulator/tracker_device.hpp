// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "drivers/dtrack/frame.hpp"
#include "drivers/simulator/sight_noise.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// One datagram and the truth behind it.
struct SimulatedDatagram {
  double measured_s{0};        ///< simulated time of the measurement
  std::int64_t arrival_ns{0};  ///< host clock; at least the constant latency after the measurement
  std::string bytes;           ///< DTrack, as a controller sends it
};

/// An optical tracker that watches the body on the scope: measures at its own clock's pace, with
/// noise, and sends each measurement late by a constant and a non-negative jitter, in order. What
/// becomes of a datagram on its way: TrackerLink. The world must outlive it.
class TrackerDevice {
 public:
  explicit TrackerDevice(const World& world);

  /// Writes the next datagram; its memory is reused. The first one is measured shortly after 0 s.
  void next(SimulatedDatagram& datagram);

 private:
  void tell_time(double measured_s);
  void tell_covariance(double measured_s);
  Pose measure(const Pose& room_from_hand, double measured_s);

  const World* world_;
  RandomStream noise_;
  SightNoise sight_;
  RandomStream arrivals_;
  double phase_;  ///< first measurement, in sampling periods
  std::uint32_t first_number_;
  std::uint32_t count_{0};
  std::int64_t last_arrival_ns_{0};
  dtrack::Frame frame_;
};

}  // namespace handeye::simulator
