// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/comparison.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "client/cli/json_file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {
namespace {

using Json = nlohmann::json;

template <std::size_t size>
std::optional<std::array<double, size>> numbers(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != size) return std::nullopt;
  std::array<double, size> values{};
  for (std::size_t i = 0; i < size; ++i) {
    if (!(*found)[i].is_number()) return std::nullopt;
    values[i] = (*found)[i].get<double>();
    if (!std::isfinite(values[i])) return std::nullopt;
  }
  return values;
}

Pose read_pose(const Json& json, const std::filesystem::path& file) {
  const auto found = json.find("hand_from_eye");
  if (found == json.end() || !found->is_object()) {
    throw InputError(file.string() + " has no hand_from_eye: there is no estimate to compare");
  }
  const auto q = numbers<4>(*found, "q_wxyz");
  const auto t_mm = numbers<3>(*found, "t_mm");
  if (!q || !t_mm) {
    throw InputError(file.string() +
                     ": hand_from_eye must have q_wxyz (4 numbers) and t_mm (3 numbers)");
  }
  const Eigen::Quaterniond rotation((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  constexpr double kTolerance = 0.01;
  if (std::abs(rotation.norm() - 1.0) > kTolerance) {
    throw InputError(file.string() + ": hand_from_eye's q_wxyz is not of length 1");
  }
  return make_pose(rotation, {(*t_mm)[0], (*t_mm)[1], (*t_mm)[2]});
}

}  // namespace

KnownCalibration read_calibration(const std::filesystem::path& file) {
  const Json json = read_json_object(file, "a result or truth file");
  KnownCalibration known;
  known.hand_from_eye = read_pose(json, file);
  const auto verdict = json.find("verdict");
  if (verdict != json.end() && verdict->is_string()) known.verdict = verdict->get<std::string>();
  const auto offset = json.find("time_offset_s");
  if (offset != json.end() && offset->is_number()) known.time_offset_s = offset->get<double>();
  return known;
}

CalibrationError calibration_error(const KnownCalibration& estimate,
                                   const KnownCalibration& truth) {
  CalibrationError error;
  error.rotation_deg = deg_from_rad(
      rotation_angle_rad(estimate.hand_from_eye.linear(), truth.hand_from_eye.linear()));
  error.translation_mm =
      (estimate.hand_from_eye.translation() - truth.hand_from_eye.translation()).norm();
  if (estimate.time_offset_s && truth.time_offset_s) {
    error.time_offset_ms = 1e3 * (*estimate.time_offset_s - *truth.time_offset_s);
  }
  return error;
}

}  // namespace handeye::cli
