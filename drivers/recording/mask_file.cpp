// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "drivers/recording/file.hpp"
#include "drivers/recording/recording.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {

cv::Mat read_mask(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path);
  cv::Mat image;
  if (!bytes.empty()) {
    const std::vector<std::uint8_t> buffer(bytes.begin(), bytes.end());
    cv::imdecode(buffer, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION, &image);
  }
  if (image.empty()) {
    throw InputError(fmt::format(
        "{}: no image that can be read; a mask is a PNG, white where usable", path.string()));
  }
  constexpr int kMiddleGrey = 127;
  cv::Mat mask = image > kMiddleGrey;
  if (cv::countNonZero(mask) == 0) {
    throw InputError(
        fmt::format("{}: all black; the usable part of a mask must be white", path.string()));
  }
  return mask;
}

}  // namespace handeye
