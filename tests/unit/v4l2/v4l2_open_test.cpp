// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <gtest/gtest.h>

#include "drivers/v4l2/v4l2_camera.hpp"

namespace handeye {
namespace {

/// What open() says; it must leave nothing open.
std::string reason(const std::string& path) {
  V4l2CameraOptions options;
  options.device = path;
  V4l2Camera camera(options);
  const std::optional<std::string> problem = camera.open();
  Frame frame;
  EXPECT_EQ(camera.grab(frame, std::chrono::milliseconds(0)), GrabStatus::kLost);
  EXPECT_EQ(camera.counters().opened, 0U);
  EXPECT_EQ(camera.description(), path);
  return problem.value_or("opened");
}

TEST(V4l2Open, SaysThatNothingIsThere) {
  EXPECT_EQ(reason("/dev/handeye-no-such-device"), "/dev/handeye-no-such-device: not there");
  EXPECT_EQ(reason(""), ": not there");
}

TEST(V4l2Open, SaysThatADeviceIsNoCamera) {
  EXPECT_EQ(reason("/dev/null"), "/dev/null: not a capture device");
}

TEST(V4l2Open, SaysThatAFileOrFolderIsNoCamera) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("handeye_v4l2_" + std::to_string(getpid()));
  std::ofstream(file) << "no camera";
  EXPECT_EQ(reason(file), file.string() + ": not a capture device");
  std::filesystem::remove(file);
  EXPECT_EQ(reason("/dev"), "/dev: not a capture device");
}

TEST(V4l2Open, SaysThatRightsAreMissing) {
  if (geteuid() == 0) GTEST_SKIP() << "root may open everything";
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("handeye_v4l2_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::none);
  EXPECT_EQ(reason(folder / "video0"),
            (folder / "video0").string() + ": permission denied; add the user to the group video");
  std::filesystem::remove(folder);
}

TEST(V4l2Device, NamesTheUsualReasons) {
  V4l2Device device;
  ASSERT_TRUE(device.open("/dev/null"));
  EXPECT_EQ(device.failure("open", EACCES),
            "/dev/null: permission denied; add the user to the group video");
  EXPECT_EQ(device.failure("open", EPERM),
            "/dev/null: forbidden by the service's unit; see DeviceAllow there");
  EXPECT_EQ(device.failure("open", EBUSY), "/dev/null: in use by another program");
  EXPECT_EQ(device.failure("open", ENODEV), "/dev/null: not there");
  EXPECT_EQ(device.failure("start the stream", EIO),
            "/dev/null: cannot start the stream: Input/output error");
}

}  // namespace
}  // namespace handeye
