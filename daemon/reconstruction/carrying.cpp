// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/carrying.hpp"

namespace handeye {

Pose carried(const Pose& eye_from_scene, const Pose& old_from_new) {
  const Pose pose = eye_from_scene * old_from_new;
  return make_pose(Eigen::Quaterniond(pose.linear()), pose.translation());
}

void carry_along(const std::vector<Pose>& before, Scene& scene, FrameHistory& frames) {
  std::size_t k = 0;
  while (k < before.size() && scene.keyframes[k].eye_from_scene.matrix() == before[k].matrix()) ++k;
  if (k == before.size()) return;
  Pose old_from_new = Pose::Identity();
  auto frame =
      frames.all().begin() + (frames.find(scene.keyframes[k].frame_index) - frames.all().data());
  for (; frame != frames.all().end(); ++frame) {
    if (k < before.size() && scene.keyframes[k].frame_index == frame->index) {
      Keyframe& keyframe = scene.keyframes[k];
      const bool adjusted = keyframe.eye_from_scene.matrix() != before[k].matrix();
      if (adjusted) {
        old_from_new = before[k].inverse() * keyframe.eye_from_scene;
      } else {
        keyframe.eye_from_scene = carried(before[k], old_from_new);
      }
      frame->eye_from_scene = keyframe.eye_from_scene;
      ++k;
    } else if (frame->eye_from_scene) {
      frame->eye_from_scene = carried(*frame->eye_from_scene, old_from_new);
    }
  }
}

}  // namespace handeye
