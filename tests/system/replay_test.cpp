// SPDX-License-Identifier: BSD-3-Clause
// `handeye replay` on recordings of the simulator: the same answer every time, and one line when a
// recording cannot be used.
#include <memory>

#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/process.hpp"

namespace handeye::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

/// The same simulated twelve seconds as a log and as a folder, recorded once for all tests.
class Replay : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    recordings_ = std::make_unique<TemporaryFolder>();
    for (const std::filesystem::path& recording : {log(), folder()}) {
      const Finished finished = run(
          {handeye_sim(), "record", recording, "--duration", "12", "--rate", "20", "--seed", "7"});
      ASSERT_EQ(finished.exit_code, 0) << finished.err;
    }
  }
  static void TearDownTestSuite() { recordings_.reset(); }

  static std::filesystem::path log() { return *recordings_ / "room.lcm"; }
  static std::filesystem::path folder() { return *recordings_ / "room"; }
  static Finished replay(const std::filesystem::path& recording,
                         const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{handeye(), "replay", recording, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  /// A copy of the folder, to be damaged.
  std::filesystem::path damaged_folder() const {
    std::filesystem::path copy = own_ / "copy";
    std::filesystem::copy(folder(), copy, std::filesystem::copy_options::recursive);
    return copy;
  }
  /// The first part of the log, beside its camera file.
  std::filesystem::path shortened_log(std::size_t bytes) const {
    std::filesystem::path copy = own_ / "short.lcm";
    write_bytes(copy, read_bytes(log()).substr(0, bytes));
    std::filesystem::copy_file(*recordings_ / "room.camera.json", own_ / "short.camera.json");
    return copy;
  }

  TemporaryFolder own_;

 private:
  static inline std::unique_ptr<TemporaryFolder> recordings_;
};

/// The result as it was printed, without the fields that tell how long things took.
std::string without_timings(const std::string& out) {
  Json result = Json::parse(out);
  EXPECT_EQ(result.erase("timings_ms"), 1U);
  for (Json& method : result.at("methods")) EXPECT_EQ(method.erase("time_ms"), 1U);
  return result.dump(2);
}

/// Path within the folder.
std::string tenth_image(const std::filesystem::path& folder) {
  const std::string row = lines_of(read_bytes(folder / "frames.csv")).at(10);
  return row.substr(row.find(',') + 1);
}

void expect_one_line(const Finished& finished, const std::vector<std::string>& words) {
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(lines_of(finished.err), SizeIs(1)) << finished.err;
  EXPECT_THAT(finished.err, StartsWith("handeye: "));
  for (const std::string& word : words) EXPECT_THAT(finished.err, HasSubstr(word));
  EXPECT_THAT(finished.out, IsEmpty());
}

TEST_F(Replay, GivesTheTrueTransformation) {
  const Finished finished = replay(log());
  EXPECT_EQ(finished.exit_code, 0) << finished.err << finished.out;
  const nlohmann::json result = parse_json(finished.out);
  const nlohmann::json truth = read_json(folder() / "truth.json");
  EXPECT_EQ(result["verdict"], "accepted");
  ASSERT_TRUE(result["hand_from_eye"].is_object());
  EXPECT_TRUE(near(pose_of(result["hand_from_eye"]), pose_of(truth["hand_from_eye"]), 0.3, 2));
  ASSERT_TRUE(result["time_offset_s"].is_number());
  EXPECT_NEAR(result["time_offset_s"].get<double>(), truth["time_offset_s"].get<double>(), 0.005);
}

TEST_F(Replay, GivesTheSameBytesEveryTimeFromLogAndFolder) {
  const Finished first = replay(log());
  const std::string expected = without_timings(first.out);
  EXPECT_EQ(without_timings(replay(log()).out), expected) << "log, second time";
  const Finished from_folder = replay(folder());
  EXPECT_EQ(from_folder.exit_code, first.exit_code);
  EXPECT_EQ(without_timings(from_folder.out), expected) << "folder of the same seed";
  EXPECT_EQ(without_timings(replay(folder()).out), expected) << "folder, second time";
}

TEST_F(Replay, RecordingThatIsNotThere) {
  expect_one_line(replay(own_ / "nowhere"), {"nowhere"});
  expect_one_line(replay(own_ / "nowhere.lcm"), {"nowhere.lcm"});
}

TEST_F(Replay, EmptyRecording) {
  std::filesystem::create_directory(own_ / "empty");
  expect_one_line(replay(own_ / "empty"), {"frames.csv"});
  write_bytes(own_ / "empty.lcm", "");
  expect_one_line(replay(own_ / "empty.lcm"), {"empty.lcm"});
  write_bytes(own_ / "header" / "frames.csv", "timestamp_ns,file\n");
  expect_one_line(replay(own_ / "header"), {"frames.csv"});
}

TEST_F(Replay, LogCutInTheMiddle) {
  expect_one_line(replay(shortened_log(std::filesystem::file_size(log()) / 2)), {"short.lcm"});
}

TEST_F(Replay, NoLogAtAll) {
  write_bytes(own_ / "text.lcm", std::string(5000, 'x'));
  expect_one_line(replay(own_ / "text.lcm"), {"text.lcm"});
}

TEST_F(Replay, TrackerFileCutShort) {
  const std::filesystem::path copy = damaged_folder();
  const std::string text = read_bytes(copy / "tracker.txt");
  write_bytes(copy / "tracker.txt", text.substr(0, text.size() / 2 - 1));
  expect_one_line(replay(copy), {"tracker.txt", "byte"});
}

TEST_F(Replay, UnreadableImage) {
  const std::filesystem::path copy = damaged_folder();
  const std::string image = tenth_image(copy);
  write_bytes(copy / image, "no image");
  expect_one_line(replay(copy), {image});
  std::filesystem::remove(copy / image);
  expect_one_line(replay(copy), {image, "frames.csv"});
}

TEST_F(Replay, ImageCutShort) {
  const std::filesystem::path copy = damaged_folder();
  const std::string image = tenth_image(copy);
  const std::string bytes = read_bytes(copy / image);
  write_bytes(copy / image, bytes.substr(0, bytes.size() / 2));
  expect_one_line(replay(copy), {image});
  write_bytes(copy / image, "");
  expect_one_line(replay(copy), {image});
}

TEST_F(Replay, IntrinsicsOfAnotherImageSize) {
  write_bytes(
      own_ / "other.json",
      R"({"width":800,"height":600,"fx":500,"fy":500,"cx":400,"cy":300,"distortion":[0,0,0,0,0]})");
  expect_one_line(replay(log(), {"--camera", own_ / "other.json"}), {"640x480", "800x600"});
}

TEST_F(Replay, NoIntrinsics) {
  const std::filesystem::path copy = damaged_folder();
  std::filesystem::remove(copy / "camera.json");
  expect_one_line(replay(copy), {"--camera"});
}

}  // namespace
}  // namespace handeye::test
