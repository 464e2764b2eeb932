// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <handeye/camera_pose_t.hpp>
#include <handeye/image_t.hpp>
#include <handeye/request_t.hpp>
#include <handeye/result_t.hpp>
#include <handeye/status_t.hpp>
#include <handeye/tracker_frame_t.hpp>

#include "protocol/bus.hpp"
#include "protocol/channels.hpp"

namespace handeye::test {

/// Hears what a daemon says, all of it in order, and asks it things without the client library: a
/// request goes out exactly as often as the test sends it. Messages are taken in only within
/// spin_until().
class Listener {
 public:
  explicit Listener(const std::string& lcm_url);

  /// Also CAMERA_POSE and TRACKER from now on.
  void hear_poses();
  /// Also FRAME from now on; only the newest is kept.
  void hear_frames();

  /// Takes messages in until the condition holds. False: it did not within `timeout`.
  bool spin_until(const std::function<bool()>& condition, std::chrono::milliseconds timeout);
  void spin_for(std::chrono::milliseconds duration);

  /// Sends the request as it is, once, whether or not it was sent before.
  void send(request_t request);
  /// Sends the request until STATUS acknowledges it, as every client must: LCM may lose one.
  /// False: no acknowledgement within `timeout`.
  bool ask(const request_t& request, std::chrono::milliseconds timeout = std::chrono::seconds(10));
  void send_frame(image_t image);

  const std::vector<status_t>& statuses() const { return statuses_; }
  const std::vector<result_t>& results() const { return results_; }
  const std::vector<camera_pose_t>& poses() const { return poses_; }
  const std::vector<tracker_frame_t>& tracker_frames() const { return tracker_frames_; }
  const std::optional<image_t>& last_frame() const { return last_frame_; }

  /// State, or request, of the newest STATUS; -1: none heard yet.
  std::int64_t session_state() const;
  std::int64_t running_request() const;
  /// What became of a request as the newest STATUS tells it; nothing: not mentioned.
  std::optional<std::int32_t> ack_code(std::int64_t request_id) const;
  std::string ack_text(std::int64_t request_id) const;
  const result_t* result_of(std::int64_t request_id) const;

 private:
  Bus bus_;
  Channels channels_;
  Publisher<request_t> requests_;
  Publisher<image_t> frames_;
  std::vector<status_t> statuses_;
  std::vector<result_t> results_;
  std::vector<camera_pose_t> poses_;
  std::vector<tracker_frame_t> tracker_frames_;
  std::optional<image_t> last_frame_;
};

/// Requests with a new request_id and all else left to the daemon.
request_t start_request(double max_duration_s);
request_t cancel_request(std::int64_t target_request_id = 0);

}  // namespace handeye::test
