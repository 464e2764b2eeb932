// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <opencv2/aruco/charuco.hpp>

#include "daemon/pattern/corner_refinement.hpp"
#include "daemon/pattern/detectors.hpp"

namespace handeye {
namespace {

// A marker's bits must be some 3 px wide to be read.
constexpr int kSearchWidth_px = 1280;
// Of a board in part: fewer corners do not hold a pose well.
constexpr std::size_t kFewestCorners = 6;

// Of the gap between a corner and the nearest marker, which must stay outside.
constexpr double kWindow = 0.9;

static_assert(kMarkerDictionaries.size() == cv::aruco::DICT_APRILTAG_36h11 + 1);

class CharucoDetector final : public BoardDetector {
 public:
  CharucoDetector(const Board& board, const BoardDetectorOptions& options)
      : board_(board),
        options_(options),
        dictionary_(cv::aruco::getPredefinedDictionary(dictionary_index(board.dictionary).value())),
        charuco_(cv::aruco::CharucoBoard::create(board.columns, board.rows,
                                                 static_cast<float>(board.square_mm),
                                                 static_cast<float>(board.marker_mm), dictionary_)),
        parameters_(cv::aruco::DetectorParameters::create()) {
    fewest_corners_ = std::min(kFewestCorners, charuco_->chessboardCorners.size());
  }

  void detect(const cv::Mat& grey, std::vector<BoardCorner>& corners) override {
    corners.clear();
    if (!search(search_image_.shrink(grey, kSearchWidth_px)) &&
        !(options_.thorough && search(search_image_.shrink(grey, grey.cols)))) {
      return;
    }
    for (cv::Point2f& pixel : pixels_) pixel = search_image_.to_full_size(pixel);
    const double spacing_px = corner_spacing_px(board_, ids_, pixels_);
    if (spacing_px <= 0) return;
    const double gap_px =
        spacing_px * 0.5 * (board_.square_mm - board_.marker_mm) / board_.square_mm;
    const std::vector<bool> good = refine_corners(grey, kWindow * gap_px, spacing_px, pixels_);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (good[i]) corners.push_back({ids_[i], {pixels_[i].x, pixels_[i].y}});
    }
    if (corners.size() < fewest_corners_) corners.clear();
  }

 private:
  bool search(const cv::Mat& grey) {
    marker_ids_.clear();
    ids_.clear();
    pixels_.clear();
    cv::aruco::detectMarkers(grey, dictionary_, markers_, marker_ids_, parameters_);
    if (marker_ids_.empty()) return false;
    cv::aruco::interpolateCornersCharuco(markers_, marker_ids_, grey, charuco_, pixels_, ids_);
    return ids_.size() >= fewest_corners_;
  }

  Board board_;
  BoardDetectorOptions options_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::CharucoBoard> charuco_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
  std::size_t fewest_corners_{kFewestCorners};
  SearchImage search_image_;
  std::vector<int> marker_ids_;
  std::vector<std::vector<cv::Point2f>> markers_;
  std::vector<int> ids_;
  std::vector<cv::Point2f> pixels_;
};

}  // namespace

std::unique_ptr<BoardDetector> make_charuco_detector(const Board& board,
                                                     const BoardDetectorOptions& options) {
  return std::make_unique<CharucoDetector>(board, options);
}

}  // namespace handeye
