// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/folder_writer.hpp"

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {

FolderWriter::FolderWriter(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_ / "frames", error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be created: {}", folder_.string(), error.message()));
  }
  frames_.open(folder_ / "frames.csv", std::ios::binary);
  tracker_.open(folder_ / "tracker.txt", std::ios::binary);
  frames_ << "timestamp_ns,file\n";
  require(frames_, "frames.csv");
  require(tracker_, "tracker.txt");
}

FolderWriter::~FolderWriter() {
  try {
    close();
  } catch (const InputError&) {
    // Nobody is left to tell: whoever wants to know calls close().
  }
}

void FolderWriter::write_frame(std::int64_t timestamp_ns, std::int64_t /*arrival_ns*/,
                               std::uint32_t /*sequence*/, int /*width*/, int /*height*/,
                               const std::vector<std::uint8_t>& jpeg) {
  const std::string name = fmt::format("frames/{:06}.jpg", frames_written_);
  std::ofstream image(folder_ / name, std::ios::binary);
  image.write(reinterpret_cast<const char*>(jpeg.data()),
              static_cast<std::streamsize>(jpeg.size()));
  image.close();
  require(image, name);
  // After its image: a recording that breaks off lists no image that is not there.
  frames_ << timestamp_ns << ',' << name << '\n';
  require(frames_, "frames.csv");
  ++frames_written_;
}

void FolderWriter::write_datagram(std::int64_t arrival_ns, std::string_view bytes) {
  tracker_ << "@ " << arrival_ns << ' ' << bytes.size() << '\n' << bytes << '\n';
  require(tracker_, "tracker.txt");
}

void FolderWriter::close() {
  if (!frames_.is_open()) return;
  frames_.close();
  tracker_.close();
  require(frames_, "frames.csv");
  require(tracker_, "tracker.txt");
}

void FolderWriter::require(const std::ofstream& file, const std::filesystem::path& path) const {
  if (!file) {
    throw InputError(fmt::format("{}: cannot be written; is the disk full, or write-protected?",
                                 (folder_ / path).string()));
  }
}

}  // namespace handeye
