// SPDX-License-Identifier: BSD-3-Clause
// `handeye replay` on pictures that a real camera took.
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/process.hpp"

namespace handeye::test {
namespace {

std::filesystem::path real_data() {
  const char* configured = std::getenv("HANDEYE_DATA");
  if (configured != nullptr) return configured;
  return std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data";
}

class RealData : public testing::Test {
 protected:
  /// Sets recording_, or skips.
  void need(const std::string& name) {
    recording_ = real_data() / name;
    if (!std::filesystem::exists(recording_ / "frames.csv")) {
      GTEST_SKIP() << recording_ << " is not there: set HANDEYE_DATA";
    }
  }

  static void expect_refused(const Finished& finished, const std::string& reason) {
    EXPECT_EQ(finished.exit_code, 3) << finished.err;
    const nlohmann::json result = parse_json(finished.out);
    EXPECT_EQ(result.at("verdict"), "refused");
    EXPECT_EQ(result.at("reason"), reason);
    EXPECT_NE(result.at("advice"), "");
  }

  /// Pictures alone: the scene is reconstructed, and only the tracker is missing.
  static void expect_reconstructed(const std::filesystem::path& recording) {
    const Finished finished = run({handeye(), "replay", recording, "--json"});
    expect_refused(finished, "tracker_lost");
    const nlohmann::json result = parse_json(finished.out);
    EXPECT_GE(result.at("frames").at("used").get<int>(), 30);
    EXPECT_LT(result.at("residuals").at("reprojection_px").get<double>(), 2);
    EXPECT_GT(result.at("residuals").at("reprojection_px").get<double>(), 0);
  }

  std::filesystem::path recording_;
};

TEST_F(RealData, SinusWithItsMask) {
  need("sinus");
  if (IsSkipped()) return;
  expect_reconstructed(recording_);
}

TEST_F(RealData, SinusWithoutItsMask) {
  need("sinus");
  if (IsSkipped()) return;
  const TemporaryFolder folder;
  std::filesystem::copy(recording_, folder / "sinus", std::filesystem::copy_options::recursive);
  std::filesystem::remove(folder / "sinus" / "mask.png");
  expect_reconstructed(folder / "sinus");
}

TEST_F(RealData, ChessboardStillsCannotBeTracked) {
  need("chessboard");
  if (IsSkipped()) return;
  expect_refused(run({handeye(), "replay", recording_, "--json"}), "too_few_features");
}

}  // namespace
}  // namespace handeye::test
