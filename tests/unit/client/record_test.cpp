// SPDX-License-Identifier: BSD-3-Clause
// `handeye record` against a sender of frames and datagrams, read back with the reader of
// recordings.
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <handeye/datagram_t.hpp>
#include <handeye/image_t.hpp>
#include <nlohmann/json.hpp>

#include "drivers/recording/recording.hpp"
#include "tests/unit/client/program_run.hpp"
#include "tests/unit/client/scripted_daemon.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;
using test::Finished;
using test::ProgramRun;
using test::ScriptedDaemon;
using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr int kWidth = 16;
constexpr int kHeight = 8;

/// Publishes a grey frame and a datagram every few milliseconds once a client has asked, as
/// the daemon does.
class Sender {
 public:
  explicit Sender(const std::string& provider)
      : bus_(provider), frames_(bus_, Channels().frame), datagrams_(bus_, Channels().datagram) {
    thread_ = std::thread([this] {
      while (!stop_) {
        if (asked) send();
        std::this_thread::sleep_for(milliseconds(4));
      }
    });
  }
  ~Sender() {
    stop_ = true;
    thread_.join();
  }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  std::atomic<bool> asked{false};
  std::atomic<int> sent{0};

 private:
  void send() {
    image_t image{};
    image.timestamp_ns = 1'000'000LL * (sent + 1);
    image.frame_number = sent;
    image.width = kWidth;
    image.height = kHeight;
    image.pixel_format = image_t::GREY8;
    image.stride = kWidth;
    image.data.assign(kWidth * kHeight, 100);
    image.size = static_cast<std::int32_t>(image.data.size());
    frames_.publish(image);
    datagram_t datagram{};
    datagram.arrival_ns = 1'000'000LL * (sent + 1);
    const std::string text = "fr " + std::to_string(sent) + "\r\n";
    datagram.data.assign(text.begin(), text.end());
    datagram.size = static_cast<std::int32_t>(datagram.data.size());
    datagrams_.publish(datagram);
    ++sent;
  }

  Bus bus_;
  Publisher<image_t> frames_;
  Publisher<datagram_t> datagrams_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class RecordCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto problem = test::lcm_problem()) GTEST_SKIP() << *problem;
  }

  std::string provider_ = test::private_provider();
  test::TemporaryFolder folder_;
};

class RecordCommandOfAKind : public RecordCommand,
                             public ::testing::WithParamInterface<std::string> {};

TEST_P(RecordCommandOfAKind, AsksTheDaemonAndWritesWhatComesUntilCtrlC) {
  Sender sender(provider_);
  const ScriptedDaemon daemon(provider_, [&](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request);
    sender.asked = request.action == request_t::RECORD && request.max_duration_s > 0;
  });
  const auto recording = folder_ / GetParam();
  ProgramRun program({"record", recording, "--json", "--lcm-url", provider_});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (sender.sent < 50 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(5));
  }
  program.interrupt();
  const Finished finished = program.wait();
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const Json summary = Json::parse(finished.out);
  EXPECT_GT(summary.at("frames").get<int>(), 0);

  const Recording read = open_recording(recording);
  EXPECT_EQ(read.datagrams.size(), summary.at("datagrams").get<std::size_t>());
  ASSERT_FALSE(read.datagrams.empty());
  EXPECT_THAT(read.datagrams.front().bytes, HasSubstr("fr "));
  ASSERT_FALSE(read.camera->open().has_value());
  Frame frame;
  int frames = 0;
  while (read.camera->grab(frame, milliseconds(100)) == GrabStatus::kFrame) {
    ++frames;
    EXPECT_EQ(frame.timestamp_ns, 1'000'000LL * (frame.sequence + 1LL));
    EXPECT_EQ(frame.grey.size(), cv::Size(kWidth, kHeight));
    EXPECT_NEAR(frame.grey.at<std::uint8_t>(4, 8), 100, 2);
  }
  EXPECT_EQ(frames, summary.at("frames").get<int>());
}

INSTANTIATE_TEST_SUITE_P(LogAndFolder, RecordCommandOfAKind,
                         ::testing::Values("recording.lcm", "recording"));

TEST_F(RecordCommand, NothingReceivedIsExitCode2) {
  const Finished finished = test::run_handeye(
      {"record", folder_ / "empty.lcm", "--duration", "0.2", "--lcm-url", provider_});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, HasSubstr("nothing was received"));
}

TEST_F(RecordCommand, NeverOverwrites) {
  const auto existing = folder_ / "existing.lcm";
  test::write_text(existing, "precious");
  const Finished finished = test::run_handeye({"record", existing, "--lcm-url", provider_});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, HasSubstr(existing.string()));
  EXPECT_EQ(test::read_text(existing), "precious");
}

}  // namespace
}  // namespace handeye
