// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/method_message.hpp"

#include "daemon/session/pose_message.hpp"

namespace handeye {
namespace {

// What method_result_t says where a method's own sigma is not known.
constexpr double kNoSigma = -1;

}  // namespace

method_result_t method_message(const MethodResult& method) {
  method_result_t message{};
  message.name = method.name;
  message.solved = method.solution.has_value();
  message.time_ms = method.time_ms;
  message.sigma_rotation_deg = method.sigma ? method.sigma->rotation_deg : kNoSigma;
  message.sigma_translation_mm = method.sigma ? method.sigma->translation_mm : kNoSigma;
  if (!method.solution) return message;
  write_pose(method.solution->hand_from_eye, message.q_wxyz, message.t_mm);
  message.scale_units_per_mm = method.solution->scale_units_per_mm;
  message.residual_rotation_deg = method.residuals.rotation_deg;
  message.residual_rotation_percent = method.residuals.rotation_percent;
  message.residual_translation_percent = method.residuals.translation_percent;
  message.residual_translation_norm_percent = method.residuals.translation_norm_percent;
  return message;
}

MethodResult method_from_message(const method_result_t& message) {
  MethodResult method;
  method.name = message.name;
  method.time_ms = message.time_ms;
  if (message.solved) {
    method.solution =
        HandEyeSolution{read_pose(message.q_wxyz, message.t_mm), message.scale_units_per_mm};
    method.residuals = {message.residual_rotation_deg, message.residual_rotation_percent,
                        message.residual_translation_percent,
                        message.residual_translation_norm_percent};
  }
  if (message.sigma_rotation_deg >= 0 && message.sigma_translation_mm >= 0) {
    method.sigma = MethodSigma{message.sigma_rotation_deg, message.sigma_translation_mm};
  }
  return method;
}

}  // namespace handeye
