// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "drivers/simulator/record.hpp"
#include "drivers/simulator/world.hpp"
#include "protocol/channels.hpp"

namespace handeye::simulator {

struct LiveOptions {
  std::string tracker_host{"127.0.0.1"};
  std::uint16_t tracker_port{5000};
  std::string lcm_url{kDefaultLcmProvider};
  std::string channel_prefix{kDefaultChannelPrefix};
  std::string camera_device;       ///< a video device that frames are written to; empty: LCM
  std::function<bool()> tracking;  ///< asked for each datagram: is it sent? Empty: all are
};

/// Runs both devices in real time: datagrams over UDP at their arrival time, frames over LCM, or
/// through a video device, at theirs. Ends after `duration_s` of simulated time (0: never) or soon
/// after `stopped()`, which is asked some 20 times a second. A frame that cannot be rendered in
/// time is skipped; nothing ever drifts. Throws InputError when a connection cannot be had.
DeviceCounts run_live(const World& world, double duration_s, const LiveOptions& options,
                      const std::function<bool()>& stopped);

}  // namespace handeye::simulator
