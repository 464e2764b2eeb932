// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "drivers/camera.hpp"

namespace handeye {

/// A datagram that owns its bytes.
struct RecordedDatagram {
  std::int64_t arrival_ns{0};
  std::string bytes;
};

/// A recording opened for reading: an LCM event log (path ends in .lcm, any channel prefix) or a
/// plain folder (frames.csv, tracker.txt, mask.png, camera.json).
struct Recording {
  std::unique_ptr<Camera> camera;           ///< frames in order; grab() returns kEnd after the last
  std::vector<RecordedDatagram> datagrams;  ///< in order of arrival; empty: no tracker data
  std::optional<CameraModel>
      camera_model;  ///< camera.json in the folder, OUT.camera.json beside OUT.lcm
  cv::Mat mask;      ///< CV_8UC1, 255 = usable; mask.png in the folder,
                     ///< OUT.mask.png beside OUT.lcm; empty: none given
};

/// Opens a recording. Throws InputError, one line that names the file, the place in it and what to
/// do, when it is missing, empty, truncated or not a recording. Images are decoded as they are
/// grabbed: a damaged one makes grab() throw InputError. The camera need not be opened.
Recording open_recording(const std::filesystem::path& path);

/// Reads a camera file: camera.json, OpenCV FileStorage (.yml, .xml) or ROS camera_info (.yaml).
/// Throws InputError.
CameraModel read_camera_model(const std::filesystem::path& path);

/// Writes camera.json. Throws InputError when the file cannot be written.
void write_camera_model(const std::filesystem::path& path, const CameraModel& camera);

/// Reads a mask (white = usable). Throws InputError.
cv::Mat read_mask(const std::filesystem::path& path);

/// Writes a recording, as the same two kinds by the same rule.
class RecordingWriter {
 public:
  RecordingWriter() = default;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  virtual ~RecordingWriter() = default;

  /// Frames and datagrams in order of arrival. `jpeg`: the encoded image. Both throw InputError
  /// when the disk is full.
  virtual void write_frame(std::int64_t timestamp_ns, std::int64_t arrival_ns,
                           std::uint32_t sequence, int width, int height,
                           const std::vector<std::uint8_t>& jpeg) = 0;
  virtual void write_datagram(std::int64_t arrival_ns, std::string_view bytes) = 0;

  /// Flushes and closes; throws InputError when the disk is full. Also called by the destructor.
  virtual void close() = 0;
};

/// Creates a recording; camera.json goes into the folder, or beside the log with the log's stem
/// (OUT.lcm -> OUT.camera.json). Refuses to overwrite: throws InputError. In a log, events carry
/// their arrival as CLOCK_REALTIME, given its distance to CLOCK_MONOTONIC now; with 0 they count
/// from the host's start, and the same input gives the same bytes.
std::unique_ptr<RecordingWriter> create_recording(const std::filesystem::path& path,
                                                  const std::optional<CameraModel>& camera,
                                                  std::int64_t realtime_minus_monotonic_ns = 0);

}  // namespace handeye
