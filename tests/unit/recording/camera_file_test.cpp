// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "drivers/recording/recording.hpp"
#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

class CameraFile : public testing::Test {
 protected:
  CameraModel read(const std::string& name, const std::string& text) {
    write_bytes(folder_ / name, text);
    return read_camera_model(folder_ / name);
  }
  void expect_refused(const std::string& name, const std::string& text,
                      const std::initializer_list<std::string>& words) {
    SCOPED_TRACE(text);
    expect_input_error([&] { read(name, text); }, words);
  }
  TemporaryFolder folder_;
};

void expect_sample_camera(const CameraModel& camera, double k3) {
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.fx, 500.5);
  EXPECT_EQ(camera.fy, 501);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{-0.25, 0.125, 0.001, -0.002, k3}));
}

const std::string kJson = R"({"width":640,"height":480,"fx":500.5,"fy":501,"cx":319.5,"cy":239.5,)"
                          R"("distortion":[-0.25,0.125,0.001,-0.002,0.5]})";

const std::string kRos = R"(image_width: 640
image_height: 480
camera_name: head_camera
camera_matrix:
  rows: 3
  cols: 3
  data: [500.5, 0.0, 319.5, 0.0, 501, 239.5, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, 0.125, 0.001, -0.002, 0.5]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
projection_matrix:
  rows: 3
  cols: 4
  data: [500.0, 0.0, 319.5, 0.0, 0.0, 501.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

TEST_F(CameraFile, ReadsJson) {
  expect_sample_camera(read("c.json", kJson), 0.5);
  expect_sample_camera(read("c.json", replaced(kJson, ",0.5]", "]")), 0);
  expect_sample_camera(read("c.json", replaced(kJson, "{", R"({"source":"given",)")), 0.5);
}

TEST_F(CameraFile, ReadsRosCameraInfo) {
  expect_sample_camera(read("c.yaml", kRos), 0.5);
  expect_sample_camera(read("c.yaml", "---\n" + kRos), 0.5);
  const std::string block =
      "data:\n    - -0.25\n    - 0.125\n    - 0.001\n    - -0.002\n    - 0.5\n";
  expect_sample_camera(
      read("c.yaml", replaced(kRos, "data: [-0.25, 0.125, 0.001, -0.002, 0.5]\n", block)), 0.5);
}

TEST_F(CameraFile, ReadsWhatOpenCvWrites) {
  const cv::Mat matrix = (cv::Mat_<double>(3, 3) << 500.5, 0, 319.5, 0, 501, 239.5, 0, 0, 1);
  const cv::Mat distortion = (cv::Mat_<double>(5, 1) << -0.25, 0.125, 0.001, -0.002, 0.5);
  for (const char* const name : {"c.yml", "c.yaml", "c.xml"}) {
    cv::FileStorage file(folder_ / name, cv::FileStorage::WRITE);
    file << "calibration_time"
         << "Sun Nov 22 2026"
         << "image_width" << 640 << "image_height" << 480;
    file << "fisheye_model" << 0 << "camera_matrix" << matrix;
    file << "distortion_coefficients" << distortion;
    file.release();
    expect_sample_camera(read_camera_model(folder_ / name), 0.5);
  }
}

TEST_F(CameraFile, NamesTheKeyThatIsMissing) {
  for (const std::string key : {"width", "height", "fx", "fy", "cx", "cy", "distortion"}) {
    expect_refused("c.json", replaced(kJson, "\"" + key + "\"", "\"other\""),
                   {"c.json", key, "missing"});
  }
  for (const std::string key :
       {"image_width", "image_height", "camera_matrix", "distortion_coefficients"}) {
    expect_refused("c.yaml", replaced(kRos, key, "other"), {"c.yaml", key, "missing"});
  }
}

TEST_F(CameraFile, NamesTheKeyOfTheWrongType) {
  expect_refused("c.json", replaced(kJson, "640", "640.5"), {"width", "whole number"});
  expect_refused("c.json", replaced(kJson, "640", "\"640\""), {"width", "whole number"});
  expect_refused("c.json", replaced(kJson, "640", "99999999999"), {"width", "out of range"});
  expect_refused("c.json", replaced(kJson, "500.5", "true"), {"fx", "number"});
  expect_refused("c.json", replaced(kJson, "500.5", "null"), {"fx", "number"});
  expect_refused("c.json", replaced(kJson, "0.125", "\"x\""), {"distortion", "numbers"});
  expect_refused("c.json", replaced(kJson, "[-0.25,0.125,0.001,-0.002,0.5]", "0"),
                 {"distortion", "numbers"});
  expect_refused("c.yaml", replaced(kRos, "640", "wide"), {"image_width", "whole number"});
  expect_refused("c.yaml", replaced(kRos, "640", "640.5"), {"image_width", "whole number"});
  expect_refused("c.yaml", replaced(kRos, "500.5", "long"), {"camera_matrix", "numbers"});
  expect_refused("c.yaml", replaced(kRos, "cols: 3", "cols: 4"), {"camera_matrix", "rows x cols"});
  expect_refused("c.yaml", replaced(kRos, "-0.25, 0.125, 0.001, -0.002, 0.5", ""),
                 {"distortion_coefficients"});
}

TEST_F(CameraFile, RefusesNumbersThatAreNoCamera) {
  expect_refused("c.json", replaced(kJson, "500.5", "NaN"), {"c.json", "line 1", "NaN"});
  expect_refused("c.json", replaced(kJson, "500.5", "0"), {"c.json", "fx"});
  expect_refused("c.json", replaced(kJson, "501", "-501"), {"c.json", "fy"});
  expect_refused("c.json", replaced(kJson, "501", "1e999"), {"c.json"});
  expect_refused("c.json", replaced(kJson, "480", "0"), {"c.json", "height"});
  expect_refused("c.yaml", replaced(kRos, "500.5", ".nan"), {"c.yaml"});
  expect_refused("c.yaml", replaced(kRos, "319.5", ".inf"), {"c.yaml"});
  expect_refused("c.yaml", replaced(kRos, "-0.25", ".Nan"), {"c.yaml"});
}

TEST_F(CameraFile, RefusesLensesWithOtherModels) {
  expect_refused("c.yaml", replaced(kRos, "plumb_bob", "equidistant"), {"distortion_model"});
  expect_refused("c.yaml", replaced(kRos, "data: [500.5, 0.0", "data: [500.5, 0.1"),
                 {"camera_matrix"});
  expect_refused("c.json", replaced(kJson, ",0.5]", ",0.5,0.1,0,0]"), {"distortion", "more than"});
  expect_sample_camera(read("c.json", replaced(kJson, ",0.5]", ",0.5,0,0,0]")), 0.5);
  expect_refused("c.json", replaced(kJson, ",0.001,-0.002,0.5]", "]"), {"distortion", "k1"});
  expect_refused("c.yaml", kRos + "fisheye_model: 1\n", {"fisheye_model"});
}

TEST_F(CameraFile, RefusesFilesThatAreNone) {
  for (const char* const name : {"c.json", "c.yaml", "c.yml", "c.xml"}) {
    expect_refused(name, "", {name});
    expect_refused(name, "this is no camera file", {name});
    expect_refused(name, "{[<%", {name});
    expect_refused(name, std::string(300, '\0'), {name});
  }
  expect_refused("c.json", "[1,2]", {"c.json", "object"});
  expect_refused("c.txt", kJson, {"c.txt", "must end in"});
  expect_input_error([&] { read_camera_model(folder_ / "no.json"); }, {"no.json", "not there"});
}

TEST_F(CameraFile, RefusesFilesCutShort) {
  for (std::size_t length = 0; length + 1 < kJson.size(); length += 5) {
    expect_refused("c.json", kJson.substr(0, length), {"c.json"});
  }
  const std::size_t needed = kRos.find("0.5]\nrectification");
  for (std::size_t length = 0; length < needed; length += 5) {
    expect_refused("c.yaml", kRos.substr(0, length), {"c.yaml"});
  }
}

TEST_F(CameraFile, IsNotWrittenWithUnusableNumbers) {
  const CameraModel camera{640, 480, std::numeric_limits<double>::quiet_NaN(), 1, 0, 0, {}};
  expect_input_error([&] { write_camera_model(folder_ / "c.json", camera); }, {"c.json", "fx"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c.json"));
}

TEST_F(CameraFile, IsNotWrittenIntoNowhere) {
  const CameraModel camera{640, 480, 500, 500, 320, 240, {}};
  expect_input_error([&] { write_camera_model(folder_ / "nowhere/c.json", camera); },
                     {"nowhere/c.json", "cannot be written"});
}

}  // namespace
}  // namespace handeye
