// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/folder_frames.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "drivers/recording/file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::string_view kHeader = "timestamp_ns,file";

/// The next line without its end ("\n" or "\r\n"); false at the end of the file.
bool read_line(std::istream& file, std::string& line) {
  if (!std::getline(file, line)) return false;
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

}  // namespace

FolderFrames::FolderFrames(const std::filesystem::path& folder) {
  read_rows(folder);
  cv::Mat first;
  read_image(rows_.front().image, first);
  summary_.frames = rows_.size();
  summary_.size = first.size();
  if (rows_.size() > 1) {
    summary_.rate_hz = static_cast<double>(rows_.size() - 1) * 1e9 /
                       static_cast<double>(rows_.back().timestamp_ns - rows_.front().timestamp_ns);
  }
}

void FolderFrames::read_rows(const std::filesystem::path& folder) {
  const std::filesystem::path table = folder / "frames.csv";
  std::ifstream file = open_for_reading(table);
  std::string line;
  if (!read_line(file, line) || line != kHeader) {
    throw InputError(fmt::format("{}: line 1: the header must be '{}'", table.string(), kHeader));
  }
  for (int number = 2; read_line(file, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw InputError(fmt::format("{}: line {}: {}", table.string(), number, what));
    };
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos) fail("a row is 'TIMESTAMP_NS,FILE'; is the file cut short?");
    const auto timestamp_ns = parse_integer<std::int64_t>(std::string_view(line).substr(0, comma));
    if (!timestamp_ns || *timestamp_ns < 0) fail("the time stamp must be whole nanoseconds");
    if (!rows_.empty() && *timestamp_ns <= rows_.back().timestamp_ns) {
      fail("the time stamp must be after the one before; sort the rows");
    }
    const std::filesystem::path image = line.substr(comma + 1);
    if (image.empty() || image.is_absolute())
      fail("the image's path must be relative to the folder");
    if (!std::filesystem::is_regular_file(folder / image)) {
      fail(fmt::format("the image {} is not there; complete the folder or take the row out",
                       image.string()));
    }
    rows_.push_back({*timestamp_ns, folder / image});
  }
  if (rows_.empty()) {
    throw InputError(
        fmt::format("{}: lists no image; record with the camera running", table.string()));
  }
}

bool FolderFrames::next(Frame& frame) {
  if (next_ == rows_.size()) return false;
  const Row& row = rows_[next_];
  read_image(row.image, frame.grey);
  if (frame.grey.size() != summary_.size) {
    throw InputError(
        fmt::format("{}: the image is {}x{}, the first of the recording is {}x{}; take its "
                    "row out of frames.csv",
                    row.image.string(), frame.grey.cols, frame.grey.rows, summary_.size.width,
                    summary_.size.height));
  }
  frame.timestamp_ns = row.timestamp_ns;
  frame.arrival_ns = row.timestamp_ns;
  frame.sequence = static_cast<std::uint32_t>(next_);
  ++next_;
  return true;
}

void FolderFrames::read_image(const std::filesystem::path& path, cv::Mat& grey) {
  std::ifstream file = open_for_reading(path);
  bytes_.assign(std::istreambuf_iterator<char>(file), {});
  bool whole = false;
  if (looks_like_jpeg(bytes_)) {
    whole = jpeg_.decode(bytes_, std::nullopt, grey);
  } else if (!bytes_.empty()) {
    // Not into `grey`: what cannot be decoded would leave the image before in it.
    grey = cv::imdecode(bytes_, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    whole = !grey.empty();
  }
  if (!whole) {
    throw InputError(
        fmt::format("{}: no image that can be read, or damaged; copy it again or take its row out "
                    "of frames.csv",
                    path.string()));
  }
}

}  // namespace handeye
