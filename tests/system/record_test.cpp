// SPDX-License-Identifier: BSD-3-Clause
// What `handeye record` takes from a running daemon, `handeye replay` calibrates from.
#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::seconds;

class RecordSystem : public RoomTest {};

TEST_F(RecordSystem, WhatWasRecordedReplaysToTheTruth) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 3}));
  ASSERT_TRUE(room.start_daemon());
  const auto streaming = [&] {
    const status_t& now = room.listener().statuses().back();
    return now.tracker.state == device_status_t::STREAMING &&
           now.camera.state == device_status_t::STREAMING;
  };
  ASSERT_TRUE(room.listener().spin_until(streaming, seconds(15)));

  const std::filesystem::path log = room.path("session.lcm");
  const Finished record = run(room.client_words(
      "record", {log, "--duration", "15", "--camera", room.path("camera.json"), "--json"}));
  ASSERT_EQ(record.exit_code, 0) << record.err;
  const nlohmann::json counts = parse_json(record.out);
  EXPECT_GT(counts.at("frames").get<int>(), 150);
  EXPECT_GT(counts.at("datagrams").get<int>(), 600);
  EXPECT_EQ(counts.at("frames_unusable"), 0);

  const Finished replay = run({handeye(), "replay", log, "--json"});
  const nlohmann::json result = parse_json(replay.out);
  EXPECT_EQ(replay.exit_code, 0) << replay.err << result.at("reason");
  ASSERT_TRUE(result.at("hand_from_eye").is_object());
  const nlohmann::json truth = read_json(room.path("truth.json"));
  EXPECT_TRUE(near(pose_of(result["hand_from_eye"]), pose_of(truth["hand_from_eye"]), 0.3, 2));
}

TEST_F(RecordSystem, AnExistingRecordingIsNotOverwritten) {
  Room room;
  write_bytes(room.path("session.lcm"), "precious");
  const Finished record =
      run(room.client_words("record", {room.path("session.lcm"), "--duration", "1"}));
  EXPECT_EQ(record.exit_code, 2);
  EXPECT_THAT(lines_of(record.err), testing::SizeIs(1)) << record.err;
  EXPECT_THAT(record.err, testing::HasSubstr("session.lcm"));
  EXPECT_EQ(read_bytes(room.path("session.lcm")), "precious");
}

}  // namespace
}  // namespace handeye::test
