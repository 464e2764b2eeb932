// SPDX-License-Identifier: BSD-3-Clause
// A tracked laparoscope over a board of dots: a plane, a strong lens, a noisy tracker.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "daemon/handeye/perspective/one_step.hpp"

namespace handeye {
namespace {

std::filesystem::path data_folder() {
  const char* configured = std::getenv("HANDEYE_DATA");
  return configured != nullptr ? std::filesystem::path(configured)
                               : std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data";
}

/// The numbers of a CSV file, line by line, comments and header left out.
std::vector<std::vector<double>> read_rows(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || (std::isdigit(line[0]) == 0 && line[0] != '-')) continue;
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  }
  return rows;
}

Observations laparoscope(const std::filesystem::path& data) {
  Observations observations{.width = 1920, .height = 1080};
  std::vector<Pose> room_from_hand;
  for (const auto& row : read_rows(data / "poses/laparoscope.csv")) {
    room_from_hand.push_back(make_pose({row[0], row[1], row[2], row[3]}, {row[4], row[5], row[6]}));
    observations.positions.push_back(
        {.hand1_from_hand = room_from_hand.front().inverse() * room_from_hand.back()});
  }
  for (const auto& row : read_rows(data / "laparoscope/dots.csv")) {
    observations.positions.at(static_cast<std::size_t>(row[0]))
        .points.push_back({{row[2], row[3], 0.0}, {row[4], row[5]}});
  }
  return observations;
}

TEST(Laparoscope, GivesTheKnownHandEyeAndLens) {
  const auto data = data_folder();
  if (!std::filesystem::exists(data / "laparoscope/dots.csv")) {
    GTEST_SKIP() << data << " is not there: set HANDEYE_DATA";
  }
  const auto found = calibrate_perspective(laparoscope(data), {});
  ASSERT_TRUE(std::holds_alternative<PerspectiveCalibration>(found))
      << std::get<PerspectiveRefusal>(found).advice;
  const auto& result = std::get<PerspectiveCalibration>(found);
  const RefinedCalibration& refined = result.refined;
  EXPECT_LT((refined.hand_from_eye.translation() - Eigen::Vector3d(-27.9, 3.4, -275.6)).norm(),
            2.0);
  EXPECT_NEAR(refined.camera.fx, 1730.0, 30.0);
  EXPECT_NEAR(refined.camera.fy, 1730.0, 30.0);
  EXPECT_NEAR(-refined.camera.k1_per_mm2 * refined.camera.fx * refined.camera.fy, -0.32, 0.08);
  // The tracker's noise must not end up in the image: as if the hand had no say in it.
  EXPECT_LT(refined.reprojection_px, 1.1 * refined.image_noise_px);
  EXPECT_GT(refined.hand_noise.translation_mm, 0.1);
  // What the known value is good for: its own residual is 0.55 deg and 1.46 mm.
  EXPECT_LT(result.sigma.hand_from_eye_mm, 3.0);
}

}  // namespace
}  // namespace handeye
