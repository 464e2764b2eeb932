// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include <opencv2/calib3d.hpp>

#include "daemon/pattern/corner_order.hpp"
#include "daemon/pattern/corner_refinement.hpp"
#include "daemon/pattern/detectors.hpp"

namespace handeye {
namespace {

// Squares must be some 10 px wide to be found. What is shrunk lacks the grain that joins squares.
constexpr int kPlainWidth_px = 480;
constexpr int kNearWidth_px = 640;
constexpr int kFarWidth_px = 1280;  // a board that fills a quarter of the view
// A side of what an image is evened out by; of one pixel alone nothing would be left.
constexpr int kLeastEvened_px = 3;
// Of the spacing: room for the corner, and to err in the shrunk image.
constexpr double kWindow = 0.2;

constexpr int kWays = 3;

// Not OpenCV's adaptive threshold: over a board that is partly out of view it takes a second and
// more, and an image that was evened out before does without.
constexpr int kQuick = cv::CALIB_CB_FAST_CHECK;
constexpr int kAdaptive =
    cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
constexpr int kSectors = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE;

class ChessboardDetector final : public BoardDetector {
 public:
  ChessboardDetector(const Board& board, const BoardDetectorOptions& options)
      : board_(board),
        options_(options),
        order_(board.columns, board.rows),
        ids_(static_cast<std::size_t>(board.columns * board.rows)) {
    std::iota(ids_.begin(), ids_.end(), 0);
  }

  void detect(const cv::Mat& grey, std::vector<BoardCorner>& corners) override {
    corners.clear();
    if (!search(grey) && !(options_.thorough && search_thoroughly(grey))) return;
    const double spacing_px = corner_spacing_px(board_, ids_, pixels_);
    const std::vector<bool> good = refine_corners(grey, kWindow * spacing_px, spacing_px, pixels_);
    if (std::ranges::find(good, false) != good.end() || !order_.arrange(grey, pixels_)) return;
    for (const int id : ids_) {
      const cv::Point2f& pixel = pixels_[static_cast<std::size_t>(id)];
      corners.push_back({id, {pixel.x, pixel.y}});
    }
  }

 private:
  cv::Size size() const { return {board_.columns, board_.rows}; }

  /// Every way of searching where the image before showed the board; else one an image, in turn,
  /// so that a board that is out of view costs a third.
  bool search(const cv::Mat& grey) {
    bool found = false;
    if (in_view_ || options_.thorough) {
      for (int way = 0; way < kWays && !found; ++way) found = search_one_way(grey, way);
    } else {
      found = search_one_way(grey, next_way_);
      next_way_ = (next_way_ + 1) % kWays;
    }
    in_view_ = found;
    return found;
  }
  bool search_one_way(const cv::Mat& grey, int way) {
    if (way == 0) return search_in(search_image_.shrink(grey, kPlainWidth_px));
    if (way == 1) return search_evened_out(grey, kNearWidth_px);
    return grey.cols > kNearWidth_px && search_evened_out(grey, kFarWidth_px);
  }
  bool search_evened_out(const cv::Mat& grey, int width) {
    const int columns = search_image_.shrink(grey, width).cols;
    // Two squares of a board that fills the image: never all dark or all light.
    const int most_squares = std::max(board_.columns, board_.rows) + 1;
    return search_in(search_image_.even_out(std::max(kLeastEvened_px, 2 * columns / most_squares)));
  }
  bool search_in(const cv::Mat& searched) {
    if (!cv::findChessboardCorners(searched, size(), pixels_, kQuick)) return false;
    for (cv::Point2f& pixel : pixels_) pixel = search_image_.to_full_size(pixel);
    return true;
  }

  /// At full size, as long as it takes.
  bool search_thoroughly(const cv::Mat& grey) {
    return cv::findChessboardCorners(grey, size(), pixels_, kAdaptive) ||
           cv::findChessboardCornersSB(grey, size(), pixels_, kSectors);
  }

  Board board_;
  BoardDetectorOptions options_;
  CornerOrder order_;
  SearchImage search_image_;
  bool in_view_{true};  ///< the first image is searched in every way
  int next_way_{0};
  std::vector<int> ids_;
  std::vector<cv::Point2f> pixels_;
};

}  // namespace

std::unique_ptr<BoardDetector> make_chessboard_detector(const Board& board,
                                                        const BoardDetectorOptions& options) {
  return std::make_unique<ChessboardDetector>(board, options);
}

}  // namespace handeye
