// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/onestep_output.hpp"

#include <utility>

#include <fmt/format.h>

#include "client/cli/result_parts.hpp"
#include "daemon/handeye/perspective/gibbs.hpp"
#include "daemon/session/result_json.hpp"

namespace handeye::cli {
namespace {

using Json = nlohmann::ordered_json;

/// gibbs is null at half a turn, where it is infinite.
Json pose_with_gibbs(const Pose& pose) {
  Json json = pose_json(pose);
  const Eigen::Vector3d gibbs = gibbs_from_rotation(Eigen::Quaterniond(pose.linear()));
  json["gibbs"] = nullptr;
  if (gibbs.allFinite()) json["gibbs"] = {gibbs.x(), gibbs.y(), gibbs.z()};
  return json;
}

Json camera_json(const PerspectiveCamera& camera) {
  return {{"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"k1_per_mm2", camera.k1_per_mm2}};
}

Json deviation_json(double rotation_deg, double translation_mm) {
  return {{"rotation_deg", rotation_deg}, {"translation_mm", translation_mm}};
}

Json matrices_json(const std::vector<PerspectiveMatrix>& matrices) {
  Json list = Json::array();
  for (const PerspectiveMatrix& m : matrices) {
    Json rows = Json::array();
    for (Eigen::Index row = 0; row < 3; ++row) {
      rows.push_back({m(row, 0), m(row, 1), m(row, 2), m(row, 3)});
    }
    list.push_back(rows);
  }
  return list;
}

/// Position and point, counted from 1 as people count, of a place among all points.
std::pair<std::size_t, std::size_t> position_and_point(std::size_t place,
                                                       const Observations& observations) {
  std::size_t position = 0;
  while (place >= observations.positions[position].points.size()) {
    place -= observations.positions[position++].points.size();
  }
  return {position + 1, place + 1};
}

Json left_out_json(const PerspectiveCalibration& calibration, const Observations& observations) {
  Json list = Json::array();
  for (const std::size_t place : calibration.left_out) {
    const auto [position, point] = position_and_point(place, observations);
    list.push_back({position, point});
  }
  return list;
}

/// "2:17, 3:4": position and point.
std::string left_out_text(const PerspectiveCalibration& calibration,
                          const Observations& observations) {
  std::string text;
  for (const std::size_t place : calibration.left_out) {
    const auto [position, point] = position_and_point(place, observations);
    text += fmt::format("{}{}:{}", text.empty() ? "" : ", ", position, point);
  }
  return text;
}

std::string pose_rows(const std::string& name, const Pose& pose, double sigma_deg,
                      double sigma_mm) {
  Eigen::Quaterniond q(pose.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d z = gibbs_from_rotation(q);
  const Eigen::Vector3d& t = pose.translation();
  return "  " + name + "\n" +
         row("  quaternion", fmt::format("w {:.6f}  x {:.6f}  y {:.6f}  z {:.6f}  +- {:.2g} deg",
                                         q.w(), q.x(), q.y(), q.z(), sigma_deg)) +
         row("  Gibbs", fmt::format("{:.6g}  {:.6g}  {:.6g}", z.x(), z.y(), z.z())) +
         row("  translation", fmt::format("x {:.3f}  y {:.3f}  z {:.3f} mm  +- {:.2g} mm", t.x(),
                                          t.y(), t.z(), sigma_mm));
}

}  // namespace

Json onestep_json(const PerspectiveCalibration& calibration, const Observations& observations) {
  const RefinedCalibration& refined = calibration.refined;
  const PerspectiveSigma& sigma = calibration.sigma;
  Json camera{{"width", observations.width}, {"height", observations.height}};
  camera.update(camera_json(refined.camera));
  camera["pixel_mm"] = {calibration.pixel_mm.x(), calibration.pixel_mm.y()};
  Json json{
      {"verdict", "accepted"},
      {"reason", nullptr},
      {"advice", ""},
      {"object_from_hand", pose_with_gibbs(refined.object_from_hand)},
      {"hand_from_eye", pose_with_gibbs(refined.hand_from_eye)},
      {"camera", camera},
      {"iterations", calibration.iterations},
      {"reprojection_px", refined.reprojection_px},
      {"left_out", left_out_json(calibration, observations)},
      {"sigma",
       {{"object_from_hand", deviation_json(sigma.object_from_hand_deg, sigma.object_from_hand_mm)},
        {"hand_from_eye", deviation_json(sigma.hand_from_eye_deg, sigma.hand_from_eye_mm)},
        {"camera", camera_json(sigma.camera)}}},
      {"noise",
       {{"image_px", refined.image_noise_px},
        {"hand", deviation_json(deg_from_rad(refined.hand_noise.rotation_rad),
                                refined.hand_noise.translation_mm)}}},
      {"matrix_method", nullptr},
      {"perspective_matrices", matrices_json(calibration.matrices)}};
  if (calibration.matrix_object_from_hand) {
    json["matrix_method"] = {
        {"object_from_hand", pose_with_gibbs(*calibration.matrix_object_from_hand)}};
  }
  return json;
}

Json onestep_json(const PerspectiveRefusal& refusal) {
  Json json{{"verdict", "refused"}, {"reason", refusal.reason}, {"advice", refusal.advice}};
  for (const char* field : {"object_from_hand", "hand_from_eye", "camera", "iterations",
                            "reprojection_px", "left_out", "sigma", "noise", "matrix_method"}) {
    json[field] = nullptr;
  }
  return json;
}

std::string onestep_text(const PerspectiveCalibration& calibration,
                         const Observations& observations, const Palette& palette) {
  const RefinedCalibration& refined = calibration.refined;
  const PerspectiveSigma& sigma = calibration.sigma;
  const PerspectiveCamera& camera = refined.camera;
  std::string text =
      palette.green("ACCEPTED") +
      fmt::format(": {} positions, {} points{}\n", observations.positions.size(),
                  observations.point_count(), observations.planar() ? " in a plane" : "");
  text += pose_rows("hand_from_eye", refined.hand_from_eye, sigma.hand_from_eye_deg,
                    sigma.hand_from_eye_mm);
  text += pose_rows("object_from_hand", refined.object_from_hand, sigma.object_from_hand_deg,
                    sigma.object_from_hand_mm);
  text += row("focal length", fmt::format("{:.3f} {:.3f} px   +- {:.3g} {:.3g} px", camera.fx,
                                          camera.fy, sigma.camera.fx, sigma.camera.fy));
  text += row("image centre", fmt::format("{:.3f} {:.3f} px   +- {:.3g} {:.3g} px", camera.cx,
                                          camera.cy, sigma.camera.cx, sigma.camera.cy));
  text += row(
      "k1", fmt::format("{:.6g} per mm^2   +- {:.3g}", camera.k1_per_mm2, sigma.camera.k1_per_mm2));
  text += row("reprojection", fmt::format("{:.3g} px rms", refined.reprojection_px));
  if (!calibration.left_out.empty()) {
    text += row("left out", palette.yellow(left_out_text(calibration, observations)) +
                                "  (position:point, gross errors in the image)");
  }
  if (refined.hand_noise.translation_mm > 0) {
    text += row("hand noise", fmt::format("{:.3g} deg {:.3g} mm per axis, estimated",
                                          deg_from_rad(refined.hand_noise.rotation_rad),
                                          refined.hand_noise.translation_mm));
  }
  return text + row("iterations",
                    fmt::format("{} of Gauss-Newton, then the refinement", calibration.iterations));
}

std::string onestep_text(const PerspectiveRefusal& refusal, const Palette& palette) {
  return fmt::format("{}: {}: {}\n", palette.red("REFUSED"), refusal.reason, refusal.advice);
}

}  // namespace handeye::cli
