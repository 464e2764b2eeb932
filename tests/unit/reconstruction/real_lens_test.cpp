// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/self_calibration.hpp"

namespace handeye {
namespace {

/// 35 frames that turn by 5 degrees at most: COLMAP ends there at seven times the focal length,
/// with a small residual.
TEST(SinusEndoscopy, GivesNoWrongLens) {
  const char* configured = std::getenv("HANDEYE_DATA");
  const auto folder =
      (configured != nullptr ? std::filesystem::path(configured)
                             : std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data") /
      "sinus";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: set HANDEYE_DATA";
  const CameraModel truth{1920, 1080, 677.171, 677.171, 872.127, 471.918, {}};
  const cv::Mat mask = cv::imread(folder / "mask.png", cv::IMREAD_GRAYSCALE);
  std::vector<std::filesystem::path> images;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "frames")) {
    images.push_back(entry.path());
  }
  std::ranges::sort(images);
  const auto tracker = make_feature_tracker();
  SelfCalibration calibration(truth, IntrinsicsMode::kEstimate);
  TrackedFrame tracked;
  std::int64_t timestamp_ns = 0;
  for (const auto& image : images) {
    tracker->track(cv::imread(image, cv::IMREAD_GRAYSCALE), mask, timestamp_ns += 833'333'333,
                   tracked);
    calibration.add(tracked);
  }
  const Lens lens = calibration.finish().lens;
  std::printf("focal length %.0f +- %.0f px where %.0f is right: %s\n", focal_px(lens.camera),
              lens.sigma.focal_px, focal_px(truth), lens.observable ? "believed" : "unobservable");
  if (lens.observable) {
    EXPECT_NEAR(focal_px(lens.camera) / focal_px(truth), 1.0, 0.15);
  }
}

}  // namespace
}  // namespace handeye
