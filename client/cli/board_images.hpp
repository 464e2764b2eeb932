// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "daemon/pattern/board_detector.hpp"

namespace handeye::cli {

/// A picture that was searched for the board.
struct BoardImage {
  std::filesystem::path file;
  std::vector<BoardCorner> corners;  ///< empty: the board was not found
};

/// Pictures of one camera.
struct BoardImages {
  std::vector<BoardImage> images;
  cv::Size size;

  std::vector<std::vector<BoardCorner>> views() const;  ///< of those in which it was found
};

/// Reads pictures and searches each for the board. Throws InputError for a file that cannot be
/// read, pictures of different sizes, and too few that show the board. `progress` is called with
/// the number of pictures done; may be empty.
BoardImages find_board(const Board& board, const std::vector<std::filesystem::path>& files,
                       const std::function<void(std::size_t done)>& progress);

}  // namespace handeye::cli
