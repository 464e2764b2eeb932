// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace handeye {

/// Default prefix of every channel; several rooms on one network use a prefix each.
inline constexpr std::string_view kDefaultChannelPrefix = "HANDEYE_";

/// Default LCM provider: UDP multicast that stays on this machine (ttl=0), with room for camera
/// frames.
inline constexpr std::string_view kDefaultLcmProvider =
    "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// The names of all channels under one prefix.
struct Channels {
  explicit Channels(std::string_view prefix = kDefaultChannelPrefix)
      : request(std::string(prefix) + "REQUEST"),
        status(std::string(prefix) + "STATUS"),
        result(std::string(prefix) + "RESULT"),
        camera_pose(std::string(prefix) + "CAMERA_POSE"),
        tracker(std::string(prefix) + "TRACKER"),
        frame(std::string(prefix) + "FRAME"),
        preview(std::string(prefix) + "PREVIEW"),
        datagram(std::string(prefix) + "DATAGRAM") {}

  std::string request;
  std::string status;
  std::string result;
  std::string camera_pose;
  std::string tracker;
  std::string frame;
  std::string preview;
  std::string datagram;
};

/// LCM reads subscriptions as regular expressions and limits a channel to 63 characters, so a
/// prefix is letters, digits, '_' and '-', at most 40 of them.
constexpr bool is_valid_channel_prefix(std::string_view prefix) {
  if (prefix.size() > 40) return false;
  for (const char c : prefix) {
    const bool allowed = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                         (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!allowed) return false;
  }
  return true;
}

}  // namespace handeye
