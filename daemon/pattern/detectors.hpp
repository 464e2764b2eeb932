// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "daemon/pattern/board_detector.hpp"

namespace handeye {

/// Quads in the thresholded image, searched at reduced size behind a check that is quick where
/// there is no board; then sub-pixel corners at full size. On real pictures this is both nearer to
/// the pinhole model and five times faster than OpenCV's sector-based detector.
std::unique_ptr<BoardDetector> make_chessboard_detector(const Board& board,
                                                        const BoardDetectorOptions& options);

/// ArUco markers, searched at reduced size; between them the corners; then as above.
std::unique_ptr<BoardDetector> make_charuco_detector(const Board& board,
                                                     const BoardDetectorOptions& options);

}  // namespace handeye
