// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/board_images.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "daemon/pattern/intrinsics.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {
namespace {

cv::Mat read_grey(const std::filesystem::path& file) {
  cv::Mat grey;
  if (std::filesystem::is_regular_file(file)) {
    grey = cv::imread(file.string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  }
  if (grey.empty()) {
    throw InputError(fmt::format("{}: {}", file.string(),
                                 std::filesystem::exists(file)
                                     ? "no image that can be read; leave it out"
                                     : "is not there"));
  }
  return grey;
}

void require_views(const Board& board, std::size_t found, std::size_t images) {
  if (found >= kFewestViews) return;
  if (found == 0) {
    throw InputError(fmt::format(
        "the board {} was found in none of {} images; are its counts those of the inner corners "
        "(ChArUco: of the squares), and is it wholly in view?",
        to_string(board), images));
  }
  throw InputError(
      fmt::format("the board {} was found in {} of {} images; at least {} are needed, and some ten "
                  "make a good calibration",
                  to_string(board), found, images, kFewestViews));
}

}  // namespace

std::vector<std::vector<BoardCorner>> BoardImages::views() const {
  std::vector<std::vector<BoardCorner>> result;
  for (const BoardImage& image : images) {
    if (!image.corners.empty()) result.push_back(image.corners);
  }
  return result;
}

BoardImages find_board(const Board& board, const std::vector<std::filesystem::path>& files,
                       const std::function<void(std::size_t done)>& progress) {
  BoardImages result;
  for (const std::filesystem::path& file : files) {
    const cv::Mat grey = read_grey(file);
    if (result.images.empty()) result.size = grey.size();
    if (grey.size() != result.size) {
      throw InputError(fmt::format(
          "{}: is {}x{}, but {} is {}x{}; all must be of one camera", file.string(), grey.cols,
          grey.rows, result.images.front().file.string(), result.size.width, result.size.height));
    }
    BoardImage& image = result.images.emplace_back(BoardImage{.file = file, .corners = {}});
    // Pictures are no video: each gets a detector of its own that remembers nothing.
    make_board_detector(board, {.thorough = true})->detect(grey, image.corners);
    if (progress) progress(result.images.size());
  }
  require_views(board, result.views().size(), result.images.size());
  return result;
}

}  // namespace handeye::cli
