// SPDX-License-Identifier: BSD-3-Clause
// A tracker that says of each measurement how good it is (6dcov): the calibration is weighted by
// it, live and in a replay, and says so.
#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr seconds kCalibrationTimeout{120};

/// tracker.txt as a tracker would have written it that does not say so.
std::string without_word(const std::string& tracker_file) {
  std::string kept;
  for (std::size_t at = 0; at < tracker_file.size();) {
    const std::size_t head_end = tracker_file.find('\n', at);
    const std::size_t count_at = tracker_file.rfind(' ', head_end) + 1;
    const std::size_t size = std::stoul(tracker_file.substr(count_at, head_end - count_at));
    std::string datagram = tracker_file.substr(head_end + 1, size);
    if (const std::size_t line = datagram.find("6dcov"); line != std::string::npos) {
      datagram.erase(line, datagram.find('\n', line) + 1 - line);
    }
    kept += tracker_file.substr(at, count_at - at) + std::to_string(datagram.size()) + '\n';
    kept += datagram + '\n';
    at = head_end + 1 + size + 1;
  }
  return kept;
}

/// Accepted, and off the truth by no more than it may be by its own word.
void expect_honest(const json& result, const json& truth) {
  ASSERT_EQ(result.value("verdict", ""), "accepted") << result.dump();
  EXPECT_EQ(result.value("method", ""), "one_step");
  EXPECT_TRUE(near(pose_of(result.at("hand_from_eye")), pose_of(truth.at("hand_from_eye")),
                   4 * result.at("sigma_rotation_deg").get<double>(),
                   4 * result.at("sigma_translation_mm").get<double>()))
      << result.dump();
}

json replay(const std::filesystem::path& recording) {
  const Finished finished = run({handeye(), "replay", recording, "--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err << finished.out;
  return parse_json(finished.out);
}

TEST(TrackerCovariance, MakesTheSameMeasurementsTellMore) {
  const TemporaryFolder folder;
  const std::filesystem::path recording = folder / "room";
  const Finished recorded = run({handeye_sim(), "record", recording, "--duration", "12", "--rate",
                                 "20", "--seed", "9", "--covariance"});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const std::string datagrams = read_bytes(recording / "tracker.txt");
  ASSERT_THAT(datagrams, HasSubstr("6dcov"));
  const json truth = read_json(recording / "truth.json");
  const json with = replay(recording);
  EXPECT_EQ(with.at("hand_noise").at("source"), "measured");
  expect_honest(with, truth);

  write_bytes(recording / "tracker.txt", without_word(datagrams));
  const json without = replay(recording);
  EXPECT_EQ(without.at("hand_noise").at("source"), "estimated");
  expect_honest(without, truth);
  // 1.3 and 1.5 on this recording: noise that is unequal is worth knowing.
  for (const char* sigma : {"sigma_rotation_deg", "sigma_translation_mm"}) {
    EXPECT_GT(without.at(sigma).get<double>(), 1.1 * with.at(sigma).get<double>()) << sigma;
  }
}

class TrackerCovarianceSystem : public RoomTest {};

TEST_F(TrackerCovarianceSystem, WeighsALiveCalibration) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 3, .extra_words = {"--covariance"}}));
  ASSERT_TRUE(room.start_daemon());
  Process client(room.client_words("calibrate", {"--json"}));
  ASSERT_TRUE(room.listener().spin_until([&] { return client.has_ended(); }, kCalibrationTimeout));
  const Finished finished = *client.wait(seconds(0));
  ASSERT_EQ(finished.exit_code, 0) << finished.err << finished.out;
  const json result = parse_json(finished.out);
  EXPECT_EQ(result.at("hand_noise").at("source"), "measured");
  expect_honest(result, read_json(room.path("truth.json")));
  EXPECT_EQ(room.listener().statuses().back().tracker.malformed, 0);
}

}  // namespace
}  // namespace handeye::test
