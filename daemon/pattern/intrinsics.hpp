// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/pattern/board_detector.hpp"

namespace handeye {

/// So many views are needed: each gives two equations for the five numbers of the pinhole.
inline constexpr std::size_t kFewestViews = 3;

struct IntrinsicsOptions {
  double max_focal_sigma{0.02};     ///< of the focal length, relative
  double max_center_sigma{0.03};    ///< of the principal point, of the image's longer side
  double max_reprojection_px{3.0};  ///< rms of all; beyond it the model or the board is wrong
  /// k3 is kept at 0 unless it explains this share of the squared reprojection errors: it fits
  /// what is not the lens too, and then bends the image where there were no corners.
  double min_k3_gain{0.1};
  double min_attitude_spread_deg{5.0};  ///< between the views' boards, to name the reason
};

/// Why a camera was not accepted; the documented word of each is intrinsics_word().
enum class IntrinsicsProblem {
  kNone,
  kParallelViews,  ///< the board was always tilted the same: the focal length is anybody's guess
  kUncertain,      ///< focal length or principal point are too uncertain
  kImplausible,    ///< a principal point outside the image, or a bad fit
};
std::string_view intrinsics_word(IntrinsicsProblem problem);  ///< empty for kNone
/// What to do about it; one sentence. Empty for kNone.
std::string_view intrinsics_advice(IntrinsicsProblem problem);

/// Standard deviations; 0: not estimated.
struct IntrinsicsSigma {
  double fx{0}, fy{0}, cx{0}, cy{0};   ///< px
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3
};

struct Intrinsics {
  IntrinsicsProblem problem{IntrinsicsProblem::kNone};
  CameraModel camera;
  IntrinsicsSigma sigma;
  double reprojection_px{0};                 ///< rms over all views
  std::vector<double> view_reprojection_px;  ///< rms of each
};

/// Zhang's calibration (A flexible new technique for camera calibration, 2000) by OpenCV: closed
/// form, then Levenberg-Marquardt over everything. `views`: the corners seen in each image, four or
/// more not on one line; at least kFewestViews of them, of images of `size`.
Intrinsics calibrate_intrinsics(const Board& board,
                                const std::vector<std::vector<BoardCorner>>& views, cv::Size size,
                                const IntrinsicsOptions& options = {});

}  // namespace handeye
