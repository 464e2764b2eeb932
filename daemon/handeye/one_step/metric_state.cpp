// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/metric_scene.hpp"

namespace handeye {

MetricState moved_by(const MetricState& state, const Eigen::VectorXd& step,
                     const std::vector<Eigen::Vector3d>& point_steps_mm) {
  MetricState moved = state;
  for (std::size_t k = 0; k < moved.room_from_eye.size(); ++k) {
    const Vector6d of_eye = step.segment<6>(unknowns_of_eye(k));
    Pose& pose = moved.room_from_eye[k];
    pose.linear() = exp_so3(of_eye.head<3>()) * pose.linear();
    pose.translation() += of_eye.tail<3>();
  }
  const Eigen::Matrix<double, kCommonUnknowns, 1> common = step.tail<kCommonUnknowns>();
  moved.hand_from_eye.linear() = exp_so3(common.head<3>()) * moved.hand_from_eye.linear();
  moved.hand_from_eye.translation() += common.segment<3>(3);
  moved.time_offset_s += common[kTimeInCommon];
  const LensVector lens_step = common.tail<kLensParameters>();
  moved.camera = with_lens(state.camera, lens_vector(state.camera) + lens_step);
  for (std::size_t j = 0; j < moved.points_mm.size(); ++j) moved.points_mm[j] += point_steps_mm[j];
  return moved;
}

}  // namespace handeye
