// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"

// Horaud, Dornaika 1995, "Hand-eye calibration", section 4: for the axes v_E = R_X v_H the unit
// quaternion of R_X minimises sum |v_E - q v_H q*|^2 = sum q^T A_i q, the smallest eigenvector of a
// symmetric 4x4 matrix. The axes are taken with the length sin(angle/2) of the quaternions' vector
// parts, since that of a small turn is known as much worse; and the eigenvector is the right
// singular vector of the stacked (Q(q_E) - W(q_H)), which does not square the condition.
namespace handeye {

std::optional<HandEyeSolution> horaud_closed_form(const HandEyeProblem& problem) {
  return rotation_then_translation(problem, eye_from_hand_rotation);
}

}  // namespace handeye
