// SPDX-License-Identifier: BSD-3-Clause
// `handeye tracker` as a script sees it, against a controller that answers as the test says.
#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/client/program_run.hpp"
#include "tests/unit/dtrack/scripted_controller.hpp"

namespace handeye {
namespace {

using dtrack::ListeningPort;
using dtrack::Peer;
using dtrack::ScriptedController;
using test::Finished;
using test::run_handeye;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// Answers from a table; what is not in it is an error.
std::function<void(Peer&)> answers(std::map<std::string, std::string> table) {
  return [table = std::move(table)](Peer& peer) {
    while (const auto command = peer.command()) {
      const auto entry = table.find(*command);
      peer.answer(entry == table.end() ? R"(dtrack2 err 7 "not now")" : entry->second);
    }
  };
}

std::map<std::string, std::string> tracker_that_is(const std::string& active) {
  return {{"dtrack2 get system access", "dtrack2 set system access full"},
          {"dtrack2 get status active", "dtrack2 set status active " + active},
          {"dtrack2 tracking start", "dtrack2 ok"},
          {"dtrack2 tracking stop", "dtrack2 ok"}};
}

std::vector<std::string> words(const std::string& action, std::uint16_t port,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> all{"tracker",   action,   "--controller",
                               "127.0.0.1", "--port", std::to_string(port)};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// One line on stderr that names the controller, nothing on stdout.
void expect_failure(const Finished& finished, int exit_code, std::uint16_t port) {
  EXPECT_EQ(finished.exit_code, exit_code);
  EXPECT_THAT(finished.out, IsEmpty());
  EXPECT_THAT(finished.err, StartsWith(fmt::format("handeye: controller 127.0.0.1:{}: ", port)));
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
}

TEST(TrackerCommand, StartsStopsAndTellsTheState) {
  const ScriptedController idle(answers(tracker_that_is("none")));
  const ScriptedController busy(answers(tracker_that_is("mea")));
  const Finished started = run_handeye(words("start", idle.port()));
  EXPECT_EQ(started.exit_code, 0) << started.err;
  EXPECT_EQ(started.out, "tracking was started\n");
  EXPECT_EQ(run_handeye(words("start", busy.port())).out, "tracking was on already\n");
  EXPECT_EQ(run_handeye(words("stop", busy.port())).out, "tracking was stopped\n");
  EXPECT_EQ(run_handeye(words("stop", idle.port())).out, "tracking was off already\n");
  const Finished status = run_handeye(words("status", busy.port()));
  EXPECT_EQ(status.exit_code, 0) << status.err;
  EXPECT_EQ(status.out, fmt::format("controller      127.0.0.1:{}\ntracker         tracking\n"
                                    "control         free\n",
                                    busy.port()));
}

TEST(TrackerCommand, TellsAllOfItAsJson) {
  const ScriptedController controller(answers(tracker_that_is("mea")));
  const Finished finished = run_handeye(words("status", controller.port(), {"--json"}));
  EXPECT_EQ(finished.exit_code, 0);
  const Json json = Json::parse(finished.out);
  EXPECT_EQ(json, Json({{"action", "status"},
                        {"controller", "127.0.0.1"},
                        {"port", controller.port()},
                        {"outcome", "done"},
                        {"activity", "measuring"},
                        {"access", "full"},
                        {"accessed_by", nullptr},
                        {"error_code", nullptr},
                        {"text", "the tracker is tracking"}}));
}

TEST(TrackerCommand, ARefusalIsExitCode3AndSaysWhy) {
  auto table = tracker_that_is("none");
  table["dtrack2 tracking start"] = R"(dtrack2 err 42 "no cameras")";
  const ScriptedController controller(answers(table));
  const Finished finished = run_handeye(words("start", controller.port()));
  expect_failure(finished, 3, controller.port());
  EXPECT_THAT(finished.err, HasSubstr("no cameras (error 42)"));

  const Finished as_json = run_handeye(words("start", controller.port(), {"--json"}));
  EXPECT_EQ(as_json.exit_code, 3);
  const Json json = Json::parse(as_json.out);
  EXPECT_EQ(json.at("outcome"), "refused");
  EXPECT_EQ(json.at("error_code"), 42);
  EXPECT_EQ(json.at("activity"), "none");
}

TEST(TrackerCommand, AnotherProgramInControlIsExitCode3AndNamed) {
  const ScriptedController controller(
      answers({{"dtrack2 get system access", "dtrack2 set system access none"},
               {"dtrack2 get system accessed_by", "dtrack2 set system accessed_by 10.0.0.7"}}));
  for (const std::string action : {"start", "stop"}) {
    const Finished finished = run_handeye(words(action, controller.port()));
    expect_failure(finished, 3, controller.port());
    EXPECT_THAT(finished.err, HasSubstr("10.0.0.7 has the control"));
  }
  const Finished status = run_handeye(words("status", controller.port()));
  EXPECT_EQ(status.exit_code, 0) << "the question was answered";
  EXPECT_THAT(status.out, HasSubstr("10.0.0.7 has it"));
}

TEST(TrackerCommand, NobodyThereOrSomebodyElseIsExitCode2) {
  const ListeningPort deaf(std::nullopt);
  const Finished refused = run_handeye(words("start", deaf.port()));
  expect_failure(refused, 2, deaf.port());
  EXPECT_THAT(refused.err, HasSubstr("Connection refused"));

  const ScriptedController mail([](Peer& peer) {
    peer.command();
    peer.answer("220 mail.example.org \033[31mESMTP");
    peer.wait_for_the_end();
  });
  const Finished garbage = run_handeye(words("status", mail.port()));
  expect_failure(garbage, 2, mail.port());
  EXPECT_THAT(garbage.err, HasSubstr("220 mail.example.org ?[31mESMTP"));

  const Finished as_json = run_handeye(words("status", mail.port(), {"--json"}));
  EXPECT_EQ(as_json.exit_code, 2);
  EXPECT_EQ(Json::parse(as_json.out).at("outcome"), "malformed");
}

TEST(TrackerCommand, NoAnswerInTimeIsExitCode4) {
  const ScriptedController silent([](Peer& peer) { peer.wait_for_the_end(); });
  const Finished finished = run_handeye(words("start", silent.port(), {"--timeout", "0.2"}));
  expect_failure(finished, 4, silent.port());
  EXPECT_THAT(finished.err, HasSubstr("no answer within 0.2 s"));
}

TEST(TrackerCommand, TakesTheControllerFromTheDaemonsConfiguration) {
  const ScriptedController controller(answers(tracker_that_is("wait")));
  const test::TemporaryFolder folder;
  const auto config = folder / "handeyed.toml";
  const auto status_with = [&](const std::string& tracker) {
    test::write_text(config, "[camera]\nintrinsics = 'camera.json'\n[tracker]\n" + tracker);
    return run_handeye({"tracker", "status", "--config", config});
  };
  const Finished found =
      status_with(fmt::format("controller = '127.0.0.1'\ncommand_port = {}\n", controller.port()));
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("waiting for its cameras"));

  const Finished none = status_with("");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("[tracker] controller names none"));
  const Finished mistake = status_with("contoller = '127.0.0.1'\n");
  EXPECT_EQ(mistake.exit_code, 1);
  EXPECT_THAT(mistake.err, HasSubstr("did you mean 'controller'?"));
  EXPECT_EQ(run_handeye({"tracker", "status", "--config", folder / "none.toml"}).exit_code, 2);
}

}  // namespace
}  // namespace handeye
