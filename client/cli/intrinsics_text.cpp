// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/intrinsics_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace handeye::cli {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Each image's reprojection error; nothing where the board was not found or there is no camera.
std::vector<std::optional<double>> reprojection_px(const Intrinsics& intrinsics,
                                                   const BoardImages& images) {
  std::vector<std::optional<double>> result;
  std::size_t view = 0;
  for (const BoardImage& image : images.images) {
    const bool known = !image.corners.empty() && view < intrinsics.view_reprojection_px.size();
    result.push_back(known ? std::optional(intrinsics.view_reprojection_px[view++]) : std::nullopt);
  }
  return result;
}

std::string image_rows(const Intrinsics& intrinsics, const BoardImages& images,
                       const Palette& palette) {
  const auto errors_px = reprojection_px(intrinsics, images);
  std::size_t longest = 5;
  for (const BoardImage& image : images.images) {
    longest = std::max(longest, image.file.string().size());
  }
  std::string text =
      "  " + palette.dim(fmt::format("{:<{}}  corners  reprojection px", "image", longest)) + "\n";
  for (std::size_t i = 0; i < images.images.size(); ++i) {
    const BoardImage& image = images.images[i];
    text += fmt::format("  {:<{}}  ", printable(image.file.string()), longest);
    text += image.corners.empty() ? palette.yellow("board not found")
                                  : fmt::format("{:>7}", image.corners.size());
    if (errors_px[i]) text += fmt::format("  {:>15.3f}", *errors_px[i]);
    text += "\n";
  }
  return text;
}

std::string figure(std::string_view name, double value, double sigma, int digits) {
  std::string text = fmt::format("  {:<3} {:>11.{}f}", name, value, digits);
  // 0: held, not estimated.
  text += sigma == 0 ? "  (held)" : fmt::format(" +- {:.{}f}", sigma, digits);
  return text + "\n";
}

std::string camera_rows(const Intrinsics& intrinsics) {
  const CameraModel& camera = intrinsics.camera;
  const IntrinsicsSigma& sigma = intrinsics.sigma;
  std::string text = figure("fx", camera.fx, sigma.fx, 3) + figure("fy", camera.fy, sigma.fy, 3) +
                     figure("cx", camera.cx, sigma.cx, 3) + figure("cy", camera.cy, sigma.cy, 3);
  constexpr std::array kNames{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    text += figure(kNames[i], camera.distortion[i], sigma.distortion[i], 6);
  }
  return text;
}

}  // namespace

std::string intrinsics_text(const Intrinsics& intrinsics, const BoardImages& images,
                            const Palette& palette) {
  const bool accepted = intrinsics.problem == IntrinsicsProblem::kNone;
  std::string text =
      accepted ? palette.green("ACCEPTED")
               : palette.red("REFUSED") + ": " + palette.bold(intrinsics_word(intrinsics.problem));
  text += fmt::format("  {} of {} images, {}x{}\n", images.views().size(), images.images.size(),
                      images.size.width, images.size.height);
  if (!accepted) text += fmt::format("  {}\n", intrinsics_advice(intrinsics.problem));
  text += image_rows(intrinsics, images, palette);
  if (intrinsics.view_reprojection_px.empty()) return text;
  if (!accepted) text += "  " + palette.red("The camera below must not be used.") + "\n";
  return text + camera_rows(intrinsics) +
         fmt::format("  reprojection {:.3f} px rms\n", intrinsics.reprojection_px);
}

Json intrinsics_json(const Intrinsics& intrinsics, const Board& board, const BoardImages& images) {
  const bool accepted = intrinsics.problem == IntrinsicsProblem::kNone;
  Json json;
  json["verdict"] = accepted ? "accepted" : "refused";
  json["reason"] = accepted ? Json(nullptr) : Json(intrinsics_word(intrinsics.problem));
  json["advice"] = intrinsics_advice(intrinsics.problem);
  json["board"] = to_string(board);
  json["camera"] = nullptr;
  json["sigma"] = nullptr;
  json["reprojection_px"] = nullptr;
  if (!intrinsics.view_reprojection_px.empty()) {
    const CameraModel& camera = intrinsics.camera;
    const IntrinsicsSigma& sigma = intrinsics.sigma;
    json["camera"] = {{"width", camera.width},
                      {"height", camera.height},
                      {"fx", camera.fx},
                      {"fy", camera.fy},
                      {"cx", camera.cx},
                      {"cy", camera.cy},
                      {"distortion", camera.distortion}};
    json["sigma"] = {{"fx", number(sigma.fx)},
                     {"fy", number(sigma.fy)},
                     {"cx", number(sigma.cx)},
                     {"cy", number(sigma.cy)},
                     {"distortion", sigma.distortion}};
    json["reprojection_px"] = number(intrinsics.reprojection_px);
  }
  const auto errors_px = reprojection_px(intrinsics, images);
  json["images"] = Json::array();
  for (std::size_t i = 0; i < images.images.size(); ++i) {
    const BoardImage& image = images.images[i];
    json["images"].push_back(
        {{"file", image.file.string()},
         {"found", !image.corners.empty()},
         {"corners", image.corners.size()},
         {"reprojection_px", errors_px[i] ? number(*errors_px[i]) : Json(nullptr)}});
  }
  return json;
}

}  // namespace handeye::cli
