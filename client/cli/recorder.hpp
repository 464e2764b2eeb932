// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <handeye/datagram_t.hpp>

#include "client/cli/stream_counter.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "drivers/image/image_message.hpp"
#include "drivers/recording/recording.hpp"
#include "protocol/bus.hpp"
#include "protocol/channels.hpp"

namespace handeye::cli {

/// Writes what comes on FRAME and DATAGRAM to a recording.
class Recorder {
 public:
  /// Listens on the bus, which must outlive this; throws InputError when the recording exists.
  Recorder(Bus& bus, const Channels& channels, const std::filesystem::path& recording,
           const std::optional<CameraModel>& camera);

  /// Handles and writes one waiting message; false: none waits. Throws InputError when writing
  /// fails.
  bool spin_once();

  /// Closes the recording; throws InputError when the disk is full.
  void close() { writer_->close(); }

  const StreamCounter& frames() const { return frames_; }
  const StreamCounter& datagrams() const { return datagrams_; }
  /// Frames that were no usable image; they are left out.
  std::int64_t unusable_frames() const { return unusable_frames_; }

  /// "512 frames, 1230 datagrams", with what was lost.
  std::string summary() const;

 private:
  void write_frame(const CheckedImage& image);
  void write_datagram(const datagram_t& datagram);
  const std::vector<std::uint8_t>& as_jpeg(const CheckedImage& image);

  Bus& bus_;
  std::unique_ptr<RecordingWriter> writer_;
  // Handlers only copy to here: an exception of the writer must not pass through LCM's C code.
  std::optional<CheckedImage> waiting_frame_;
  std::optional<datagram_t> waiting_datagram_;
  StreamCounter frames_;
  StreamCounter datagrams_;
  std::int64_t unusable_frames_{0};
  std::vector<std::uint8_t> encoded_;
};

}  // namespace handeye::cli
