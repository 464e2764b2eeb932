// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/recorder.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace handeye::cli {
namespace {

constexpr int kJpegQuality = 95;

std::string with_loss(std::string_view what, const StreamCounter& counter) {
  std::string text = fmt::format("{} {}", counter.received(), what);
  if (counter.lost() > 0) text += fmt::format(" ({} lost on LCM)", counter.lost());
  return text;
}

}  // namespace

Recorder::Recorder(Bus& bus, const Channels& channels, const std::filesystem::path& recording,
                   const std::optional<CameraModel>& camera)
    : bus_(bus), writer_(create_recording(recording, camera)) {
  bus.subscribe<CheckedImage>(channels.frame,
                              [this](const CheckedImage& image) { waiting_frame_ = image; });
  bus.subscribe<datagram_t>(channels.datagram,
                            [this](const datagram_t& datagram) { waiting_datagram_ = datagram; });
}

bool Recorder::spin_once() {
  if (!bus_.handle(std::chrono::milliseconds(0))) return false;
  if (waiting_frame_) write_frame(*waiting_frame_);
  if (waiting_datagram_) write_datagram(*waiting_datagram_);
  waiting_frame_.reset();
  waiting_datagram_.reset();
  return true;
}

std::string Recorder::summary() const {
  std::string text =
      with_loss("frames", frames_) + ", " + with_loss("datagrams of the tracker", datagrams_);
  if (unusable_frames_ > 0) text += fmt::format(", {} unusable frames left out", unusable_frames_);
  return text;
}

void Recorder::write_frame(const CheckedImage& image) {
  frames_.take(image.session_id, image.seq);
  if (image_problem(image)) {
    ++unusable_frames_;
    return;
  }
  writer_->write_frame(image.timestamp_ns, monotonic_ns(),
                       static_cast<std::uint32_t>(image.frame_number), image.width, image.height,
                       as_jpeg(image));
}

void Recorder::write_datagram(const datagram_t& datagram) {
  datagrams_.take(datagram.session_id, datagram.seq);
  writer_->write_datagram(datagram.arrival_ns, {reinterpret_cast<const char*>(datagram.data.data()),
                                                datagram.data.size()});
}

const std::vector<std::uint8_t>& Recorder::as_jpeg(const CheckedImage& image) {
  if (image.pixel_format == image_t::JPEG) return image.data;
  const EncodedImage grey = encoded_image(image);
  constexpr std::size_t kNoPadding = cv::Mat::AUTO_STEP;
  const std::size_t stride =
      grey.stride_bytes > 0 ? static_cast<std::size_t>(grey.stride_bytes) : kNoPadding;
  // OpenCV has no matrix of constant bytes; imencode only reads.
  const cv::Mat view(grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.bytes.data()),
                     stride);
  cv::imencode(".jpg", view, encoded_, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return encoded_;
}

}  // namespace handeye::cli
