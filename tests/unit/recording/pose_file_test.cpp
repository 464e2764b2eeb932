// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/pose_file.hpp"

#include <gtest/gtest.h>

#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

const std::string kHeader = std::string(kPoseFileHeader) + "\n";
const std::string kRow = "0.5,-0.5,0.5,0.5,1,-2,3.5,1,0,0,0,-4e1,+5,6\n";

class PoseFile : public testing::Test {
 protected:
  std::vector<PoseRow> read(const std::string& text) {
    write_bytes(path_, text);
    return read_pose_file(path_);
  }
  void expect_refused(const std::string& text, const std::initializer_list<std::string>& words) {
    SCOPED_TRACE(text);
    expect_input_error([&] { read(text); }, words);
  }
  static void expect_is_row(const PoseRow& row) {
    const Pose hand = make_pose(Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), {1, -2, 3.5});
    EXPECT_TRUE(row.room_from_hand.isApprox(hand, 1e-15));
    EXPECT_TRUE(row.eye_from_scene.linear().isIdentity(1e-15));
    EXPECT_EQ(row.eye_from_scene.translation(), Eigen::Vector3d(-40, 5, 6));
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "poses.csv";
};

TEST_F(PoseFile, ReadsRealPartFirstAndRowByRow) {
  const auto rows = read(kHeader + kRow + "1,0,0,0,0,0,0,0,0,0,-1,0,0,0\n");
  ASSERT_EQ(rows.size(), 2U);
  expect_is_row(rows[0]);
  EXPECT_TRUE(rows[1].eye_from_scene.linear().isApprox(
      Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix(), 1e-15));
}

TEST_F(PoseFile, ToleratesWhatEditorsAndSpreadsheetsDo) {
  std::string spaced = kHeader + kRow;
  for (std::size_t at = 0; (at = spaced.find(',', at)) != std::string::npos; at += 3) {
    spaced.replace(at, 1, " ,\t");
  }
  std::string windows = kHeader + kRow;
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) {
    windows.replace(at, 1, "\r\n");
  }
  const std::string cut = kHeader + kRow.substr(0, kRow.size() - 1);
  for (const std::string& text : {spaced, windows, cut, kHeader + kRow + "\n \r\n\n",
                                  windows + "\r\n\r\n", "\xEF\xBB\xBF" + kHeader + kRow}) {
    SCOPED_TRACE(text);
    const auto rows = read(text);
    ASSERT_EQ(rows.size(), 1U);
    expect_is_row(rows[0]);
  }
}

TEST_F(PoseFile, MayHaveNoRows) {
  EXPECT_TRUE(read(kHeader).empty());
  EXPECT_TRUE(read(kHeader + "\n\n").empty());
}

TEST_F(PoseFile, NormalisesRoundedQuaternions) {
  const auto rows = read(kHeader + "0.7071,0.7071,0,0,0,0,0,0.577,0.577,0,0.578,0,0,0\n");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(rows[0].eye_from_scene.linear().isUnitary(1e-12));
}

TEST_F(PoseFile, RefusesOtherHeaders) {
  expect_refused("", {"poses.csv: line 1", "header must be 'hand_qw,"});
  expect_refused("\n" + kHeader + kRow, {"line 1", "header"});
  expect_refused(kRow, {"line 1", "header", "'0.5,-0.5"});
  expect_refused("timestamp_ns,file\n", {"line 1", "not 'timestamp_ns,file'"});
  std::string eye_first = kHeader;
  eye_first.replace(0, 7, "eye_qw");
  expect_refused(eye_first + kRow, {"line 1", "header"});
  expect_refused(std::string(kPoseFileHeader) + ",time\n", {"line 1", "header"});
}

TEST_F(PoseFile, RefusesOtherNumbersOfFields) {
  const std::string good = kRow.substr(0, kRow.size() - 1);
  expect_refused(kHeader + kRow + good + ",7\n", {"poses.csv: line 3", "has 15 of 14 fields"});
  expect_refused(kHeader + good.substr(0, good.rfind(',')) + "\n", {"line 2", "has 13 of 14"});
  expect_refused(kHeader + "\n" + kRow, {"line 2", "has 1 of 14"});
}

TEST_F(PoseFile, NamesTheColumnOfWhatIsNoNumber) {
  const auto with_third = [](const std::string& field) {
    return kHeader + kRow + "1,0," + field + ",0,0,0,0,1,0,0,0,0,0,0\n";
  };
  for (const std::string field : {"abc", "0.1.2", "0x1", "1e", "--1", "1 2", "\x1b[31m"}) {
    expect_refused(with_third(field), {"poses.csv: line 3, column 3 (hand_qy)", "not a number"});
  }
  expect_refused(with_third(""), {"line 3, column 3 (hand_qy)", "is empty"});
  for (const std::string field : {"nan", "NaN", "-inf", "Infinity"}) {
    expect_refused(with_third(field), {"line 3, column 3 (hand_qy)", "take out"});
  }
  for (const std::string field : {"1e999", "-1e300", "2e15"}) {
    expect_refused(with_third(field), {"line 3, column 3 (hand_qy)", "beyond"});
  }
}

TEST_F(PoseFile, RefusesQuaternionsThatAreNoRotation) {
  expect_refused(kHeader + "0,0,0,0,0,0,0,1,0,0,0,0,0,0\n",
                 {"line 2, column 1 (hand_qw)", "norm is 0 instead of 1"});
  expect_refused(kHeader + kRow + "1,0,0,0,0,0,0,1,0.05,0,0,0,0,0\n",
                 {"line 3, column 8 (eye_qw)", "norm is 1.00125"});
  expect_refused(kHeader + "1e9,1e9,0,0,0,0,0,1,0,0,0,0,0,0\n", {"line 2, column 1"});
}

TEST_F(PoseFile, RefusesWhatIsNoFile) {
  expect_input_error([&] { read_pose_file(folder_ / "none.csv"); }, {"none.csv", "not there"});
  expect_input_error([&] { read_pose_file(folder_ / "."); }, {"folder"});
}

}  // namespace
}  // namespace handeye
