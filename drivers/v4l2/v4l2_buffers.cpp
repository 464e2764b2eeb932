// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_buffers.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <sys/mman.h>

namespace handeye {
namespace {

constexpr std::uint32_t kWantedBuffers = 4;
constexpr std::uint32_t kLeastBuffers = 2;

/// A buffer request with room for its planes.
struct BufferRequest {
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  v4l2_buffer buffer{};

  BufferRequest(const V4l2Device& device, std::uint32_t index, std::uint32_t plane_count) {
    buffer.type = device.buffer_type();
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    if (device.multiplanar()) {
      buffer.m.planes = planes.data();
      buffer.length = plane_count;
    }
  }
};

}  // namespace

std::optional<std::string> V4l2Buffers::start(const V4l2Device& device) {
  release();
  v4l2_requestbuffers buffers{};
  buffers.type = device.buffer_type();
  buffers.memory = V4L2_MEMORY_MMAP;
  buffers.count = kWantedBuffers;
  if (const int error = device.request(VIDIOC_REQBUFS, &buffers); error != 0) {
    return device.failure("get buffers", error);
  }
  if (buffers.count < kLeastBuffers) return device.path() + ": has too little memory for buffers";
  for (std::uint32_t index = 0; index < buffers.count; ++index) {
    if (auto problem = map(device, index)) return problem;
    if (const int error = give_back(device, index); error != 0) {
      return device.failure("queue a buffer", error);
    }
  }
  int type = device.buffer_type();
  if (const int error = device.request(VIDIOC_STREAMON, &type); error != 0) {
    return device.failure("start the stream", error);
  }
  return std::nullopt;
}

std::optional<std::string> V4l2Buffers::map(const V4l2Device& device, std::uint32_t index) {
  BufferRequest request(device, index, VIDEO_MAX_PLANES);
  if (const int error = device.request(VIDIOC_QUERYBUF, &request.buffer); error != 0) {
    return device.failure("query a buffer", error);
  }
  std::size_t length = request.buffer.length;
  std::uint32_t offset = request.buffer.m.offset;
  if (device.multiplanar()) {
    planes_ = request.buffer.length;
    length = request.planes[0].length;
    offset = request.planes[0].m.mem_offset;
  }
  void* const memory = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED,
                            device.descriptor(), static_cast<off_t>(offset));
  if (memory == MAP_FAILED) return device.failure("map a buffer", errno);
  mappings_.push_back({memory, length});
  return std::nullopt;
}

int V4l2Buffers::take(const V4l2Device& device, V4l2Filled& filled) {
  BufferRequest request(device, 0, planes_);
  if (const int error = device.request(VIDIOC_DQBUF, &request.buffer); error != 0) return error;
  const v4l2_buffer& buffer = request.buffer;
  if (buffer.index >= mappings_.size()) return EPROTO;
  std::size_t begin = 0;
  std::size_t end = buffer.bytesused;
  if (device.multiplanar()) {
    begin = request.planes[0].data_offset;
    end = request.planes[0].bytesused;
  }
  const Mapping& mapping = mappings_[buffer.index];
  end = std::min(end, mapping.length);
  begin = std::min(begin, end);
  filled.index = buffer.index;
  filled.flags = buffer.flags;
  filled.sequence = buffer.sequence;
  filled.timestamp = buffer.timestamp;
  filled.bytes = {static_cast<const std::uint8_t*>(mapping.memory) + begin, end - begin};
  return 0;
}

int V4l2Buffers::give_back(const V4l2Device& device, std::uint32_t index) {
  BufferRequest request(device, index, planes_);
  return device.request(VIDIOC_QBUF, &request.buffer);
}

void V4l2Buffers::release() {
  for (const Mapping& mapping : mappings_) munmap(mapping.memory, mapping.length);
  mappings_.clear();
  planes_ = 1;
}

}  // namespace handeye
