// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/start_method.hpp"
#include "daemon/reconstruction/start_window.hpp"

namespace handeye {

/// Start from the first frame and one other: every motion that the two views allow (`motions`, see
/// two_view_motions), with the points of the two, against which the other frames are resected.
std::vector<StartHypothesis> start_by_two_views(const CameraModel& camera,
                                                const ReconstructionOptions& options,
                                                const StartWindow& window, Eigen::Index other,
                                                const std::vector<TwoViewMotion>& motions);

}  // namespace handeye
