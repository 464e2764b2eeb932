// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "drivers/recording/recording.hpp"

namespace handeye {

/// A short recording with known contents.
struct SampleRecording {
  int width{64};
  int height{48};
  std::vector<std::int64_t> timestamps_ns{1'000'000'000, 1'040'000'000, 1'080'000'000,
                                          1'160'000'000};
  std::vector<std::uint32_t> sequences{0xFFFF'FFFE, 0xFFFF'FFFF, 0,
                                       2};  // wraps, then one is missing
  std::vector<RecordedDatagram> datagrams{{999'000'000, "fr 1\r\n6d 0 \r\n"},
                                          {1'020'000'000, ""},
                                          {1'050'000'000, std::string("\0@ 1 2\n", 7)}};
  std::optional<CameraModel> camera{
      CameraModel{64, 48, 70.5, 71.25, 31.5, 23.5, {-0.1, 0.01, 0, 0, 0}}};

  /// Image `index`: a brightness of its own and a gradient.
  cv::Mat image(std::size_t index) const {
    cv::Mat grey(height, width, CV_8UC1);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        grey.at<std::uint8_t>(y, x) =
            static_cast<std::uint8_t>(40 * index + static_cast<std::size_t>(x + y));
      }
    }
    return grey;
  }

  std::vector<std::uint8_t> jpeg(std::size_t index) const {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", image(index), bytes);
    return bytes;
  }

  /// Writes everything in order of time; frames arrive 5 ms after their time stamp.
  void write(const std::filesystem::path& path) const {
    const auto writer = create_recording(path, camera);
    std::size_t next = 0;
    for (std::size_t i = 0; i < timestamps_ns.size(); ++i) {
      const std::int64_t arrival_ns = timestamps_ns[i] + 5'000'000;
      for (; next < datagrams.size() && datagrams[next].arrival_ns < arrival_ns; ++next) {
        writer->write_datagram(datagrams[next].arrival_ns, datagrams[next].bytes);
      }
      writer->write_frame(timestamps_ns[i], arrival_ns, sequences[i], width, height, jpeg(i));
    }
    writer->close();
  }
};

/// Reads every frame and thereby decodes it; the number of frames.
inline int read_all_frames(const std::filesystem::path& path) {
  const Recording recording = open_recording(path);
  Frame frame;
  int frames = 0;
  while (recording.camera->grab(frame, std::chrono::milliseconds(0)) == GrabStatus::kFrame)
    ++frames;
  return frames;
}

}  // namespace handeye
