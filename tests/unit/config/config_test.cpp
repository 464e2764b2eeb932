// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/config.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

using testing::HasSubstr;

/// A configuration file that lives as long as the test.
class ConfigFile {
 public:
  explicit ConfigFile(const std::string& text)
      : path_(std::filesystem::path(testing::TempDir()) /
              (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
               ".toml")) {
    std::ofstream(path_) << text;
  }
  ~ConfigFile() { std::filesystem::remove(path_); }
  ConfigFile(const ConfigFile&) = delete;
  ConfigFile& operator=(const ConfigFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string mistake_in(const std::string& text) {
  const ConfigFile file(text);
  try {
    load_config(file.path());
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no mistake found";
}

TEST(Config, ReadsEverySection) {
  const ConfigFile file(R"(
[lcm]
url = "udpm://239.255.76.67:7777?ttl=0"
prefix = "OR3_"
[tracker]
port = 5001
interface = "eth1"
bind_address = "10.0.0.2"
multicast_group = "239.0.0.5"
controller = "10.0.0.9"
command_port = 50106
start_tracking = true
body_id = 4
noise = "given"
noise_rotation_deg = 0.1
noise_translation_mm = 0.2
[camera]
driver = "lcm"
intrinsics = "camera.json"
mask = "/abs/mask.png"
[calibration]
sigma_rotation_deg = 0.2
sigma_translation_mm = 1
min_duration_s = 5
max_duration_s = 40.5
keep = false
store = "kept.json"
[service]
realtime_priority = 0
stuck_after_s = 1.5
solver_stuck_after_s = 60
[camera_pose]
wait_ms = 12.5
predict_ms = 0
[log]
level = "debug"
)");
  const Config config = load_config(file.path());
  EXPECT_EQ(config.lcm.prefix, "OR3_");
  EXPECT_EQ(config.tracker.port, 5001);
  EXPECT_EQ(config.tracker.interface, "eth1");
  EXPECT_EQ(config.tracker.controller, "10.0.0.9");
  EXPECT_EQ(config.tracker.command_port, 50106);
  EXPECT_TRUE(config.tracker.start_tracking);
  EXPECT_EQ(config.tracker.body_id, 4);
  EXPECT_EQ(config.tracker.noise, HandNoiseSource::kGiven);
  EXPECT_DOUBLE_EQ(config.tracker.noise_translation_mm, 0.2);
  EXPECT_EQ(config.camera.driver, Config::Camera::Driver::kLcm);
  EXPECT_EQ(config.camera.intrinsics, file.path().parent_path() / "camera.json")
      << "relative to the configuration file";
  EXPECT_EQ(config.camera.mask, "/abs/mask.png");
  EXPECT_DOUBLE_EQ(config.calibration.wanted.translation_mm, 1.0) << "a whole number is a number";
  EXPECT_DOUBLE_EQ(config.calibration.max_duration_s, 40.5);
  EXPECT_FALSE(config.calibration.keep);
  EXPECT_EQ(config.calibration.store, file.path().parent_path() / "kept.json");
  EXPECT_EQ(config.service.realtime_priority, 0);
  EXPECT_DOUBLE_EQ(config.service.stuck_after_s, 1.5);
  EXPECT_DOUBLE_EQ(config.service.solver_stuck_after_s, 60);
  EXPECT_DOUBLE_EQ(config.camera_pose.wait_ms, 12.5);
  EXPECT_DOUBLE_EQ(config.camera_pose.predict_ms, 0);
  EXPECT_EQ(config.log.level, "debug");
}

TEST(Config, HasDefaultsForEverythingButTheIntrinsics) {
  const ConfigFile file("[camera]\nintrinsics = 'camera.json'\n");
  const Config config = load_config(file.path());
  EXPECT_EQ(config.tracker.port, 5000);
  EXPECT_EQ(config.tracker.command_port, 50105);
  EXPECT_FALSE(config.tracker.start_tracking) << "the tracker is never touched unless told";
  EXPECT_EQ(config.tracker.noise, HandNoiseSource::kMeasured);
  EXPECT_EQ(config.camera.driver, Config::Camera::Driver::kV4l2);
  EXPECT_EQ(config.lcm.prefix, kDefaultChannelPrefix);
  EXPECT_DOUBLE_EQ(config.calibration.wanted.rotation_deg, 0.3);
  EXPECT_TRUE(config.calibration.keep);
  EXPECT_EQ(config.calibration.store, "") << "systemd says where";
  EXPECT_EQ(config.service.realtime_priority, 20);
  EXPECT_DOUBLE_EQ(config.camera_pose.wait_ms, 20);
  EXPECT_DOUBLE_EQ(config.camera_pose.predict_ms, 60);
}

TEST(Config, NamesLineAndKeyOfAMistake) {
  const std::string head = "[camera]\nintrinsics = 'c.json'\n";
  EXPECT_THAT(mistake_in(head + "[tracker]\nport = 70000\n"),
              HasSubstr(".toml:4: [tracker] port: must be a whole number from 0 to 65535"));
  EXPECT_THAT(mistake_in(head + "[tracker]\nport = '5000'\n"), HasSubstr(":4: [tracker] port"));
  EXPECT_THAT(mistake_in(head + "[tracker]\nprot = 5000\n"),
              HasSubstr(":4: [tracker] prot: is not a key; did you mean 'port'?"));
  EXPECT_THAT(mistake_in(head + "[trakcer]\n"), HasSubstr(":3: [trakcer] is not a section"));
  EXPECT_THAT(mistake_in(head + "[calibration]\nsigma_rotation_deg = nan\n"),
              HasSubstr("[calibration] sigma_rotation_deg: must be a number"));
  EXPECT_THAT(mistake_in(head + "[calibration]\nmin_duration_s = 50\n"),
              HasSubstr("min_duration_s: must not be above max_duration_s"));
  EXPECT_THAT(mistake_in(head + "[camera_pose]\nwait_ms = -1\n"),
              HasSubstr(":4: [camera_pose] wait_ms: must be a number from 0 to 150"));
  EXPECT_THAT(mistake_in(head + "[camera_pose]\npredict_ms = 1000\n"),
              HasSubstr("[camera_pose] predict_ms: must be a number from 0 to 200"));
  EXPECT_THAT(mistake_in(head + "[camera_pose]\npredict = 10\n"),
              HasSubstr("predict: is not a key; did you mean 'predict_ms'?"));
  EXPECT_THAT(mistake_in(head + "[camera_poses]\n"), HasSubstr("did you mean [camera_pose]?"));
  EXPECT_THAT(mistake_in(head + "[lcm]\nprefix = 'a.*'\n"), HasSubstr(":4: [lcm] prefix"));
  EXPECT_THAT(mistake_in(head + "[tracker]\ncontroller = 'localhost'\n"),
              HasSubstr("must be an IPv4 address"));
  EXPECT_THAT(mistake_in(head + "[tracker]\ncommand_port = 0\n"),
              HasSubstr(":4: [tracker] command_port: must be a whole number from 1 to 65535"));
  EXPECT_THAT(mistake_in(head + "[tracker]\nstart_tracking = 1\n"),
              HasSubstr(":4: [tracker] start_tracking: must be true or false"));
  EXPECT_THAT(mistake_in(head + "[tracker]\nstart_tracking = true\n"),
              HasSubstr(":4: [tracker] start_tracking: needs the controller's address"));
  EXPECT_THAT(mistake_in(head + "driver = 'webcam'\n"), HasSubstr("must be one of v4l2, lcm"));
  EXPECT_THAT(mistake_in("[camera]\n"), HasSubstr("[camera] intrinsics: is missing"));
  EXPECT_THAT(mistake_in(head + "[log]\nlevel = \n"), HasSubstr(":4")) << "not TOML at all";
  EXPECT_THAT(mistake_in("camera = 3\n"), HasSubstr("must be a section"));
}

TEST(Config, NeedsNoIntrinsicsWhereTheLensIsEstimated) {
  const ConfigFile file("[camera]\nintrinsics_mode = 'estimate'\nwidth = 640\nheight = 480\n");
  const Config config = load_config(file.path());
  EXPECT_EQ(config.camera.intrinsics_mode, IntrinsicsMode::kEstimate);
  EXPECT_TRUE(config.camera.intrinsics.empty());
  EXPECT_THAT(mistake_in("[camera]\nintrinsics_mode = 'estimate'\nwidth = 640\n"),
              HasSubstr("height: is needed"));
  EXPECT_THAT(mistake_in("[camera]\nintrinsics_mode = 'refine'\n"),
              HasSubstr("[camera] intrinsics: is missing"));
  EXPECT_THAT(mistake_in("[camera]\nintrinsics_mode = 'guess'\nintrinsics = 'c.json'\n"),
              HasSubstr("must be one of fixed, refine, estimate"));
}

TEST(Config, SaysThatAFileCannotBeRead) {
  EXPECT_THROW(load_config("/nonexistent/handeyed.toml"), InputError);
  EXPECT_THROW(load_config(testing::TempDir()), InputError) << "a folder";
}

}  // namespace
}  // namespace handeye
