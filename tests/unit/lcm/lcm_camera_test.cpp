// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lcm/lcm_camera.hpp"

#include <limits>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <handeye/request_t.hpp>
#include <opencv2/imgcodecs.hpp>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::chrono::milliseconds kNoWait(0);
constexpr std::chrono::milliseconds kShort(100);
constexpr std::chrono::milliseconds kPatient(10'000);
constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A UDP port that nobody uses now.
int free_port() {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t length = sizeof address;
  bind(probe, reinterpret_cast<const sockaddr*>(&address), length);
  getsockname(probe, reinterpret_cast<sockaddr*>(&address), &length);
  close(probe);
  return ntohs(address.sin_port);
}

/// A camera and a sender on an LCM network of their own.
class LcmCameraTest : public testing::Test {
 protected:
  void SetUp() override {
    options_.provider_url = "udpm://239.255.76.67:" + std::to_string(free_port()) + "?ttl=0";
    try {
      sender_ = std::make_unique<Bus>(options_.provider_url);
    } catch (const InputError& error) {
      GTEST_SKIP() << "opening LCM at " << options_.provider_url
                   << " for a camera and a sender failed: " << error.what();
    }
    publisher_.emplace(*sender_, options_.channel);
    camera_.emplace(options_);
    ASSERT_EQ(camera_->open(), std::nullopt);
  }

  static cv::Mat picture(int number) {
    return cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(20 * number));
  }

  /// A JPEG image, stamped now.
  static image_t image(int number) {
    image_t image{};
    image.timestamp_ns = monotonic_ns();
    image.frame_number = number;
    image.width = kWidth;
    image.height = kHeight;
    image.pixel_format = image_t::JPEG;
    cv::imencode(".jpg", picture(number), image.data);
    image.size = static_cast<std::int32_t>(image.data.size());
    return image;
  }

  void send(image_t image) { ASSERT_TRUE(publisher_->publish(image)); }

  /// Expects image `number` to be the next frame.
  void expect_frame(int number) {
    ASSERT_EQ(camera_->grab(frame_, kPatient), GrabStatus::kFrame);
    EXPECT_EQ(frame_.sequence, static_cast<std::uint32_t>(number));
    ASSERT_EQ(frame_.grey.size(), cv::Size(kWidth, kHeight));
    EXPECT_LE(cv::norm(frame_.grey, picture(number), cv::NORM_INF), 2);
  }

  LcmCameraOptions options_;
  std::unique_ptr<Bus> sender_;
  std::optional<Publisher<image_t>> publisher_;
  std::optional<LcmCamera> camera_;
  Frame frame_;
};

TEST_F(LcmCameraTest, HandsOutEveryImageInOrder) {
  const std::int64_t before_ns = monotonic_ns();
  for (int number = 1; number <= 6; ++number) send(image(number));
  std::int64_t last_ns = before_ns;
  for (int number = 1; number <= 6; ++number) {
    expect_frame(number);
    EXPECT_GT(frame_.timestamp_ns, last_ns);
    EXPECT_GE(frame_.arrival_ns, frame_.timestamp_ns);
    last_ns = frame_.timestamp_ns;
  }
  EXPECT_EQ(camera_->counters().received, 6U);
  EXPECT_EQ(camera_->counters().dropped, 0U);
  EXPECT_EQ(camera_->counters().malformed, 0U);
}

TEST_F(LcmCameraTest, TakesUncompressedImagesWithPadding) {
  image_t grey = image(3);
  grey.pixel_format = image_t::GREY8;
  grey.stride = kWidth + 16;
  grey.size = grey.stride * kHeight;
  grey.data.assign(static_cast<std::size_t>(grey.size), 60);
  send(grey);
  expect_frame(3);
}

TEST_F(LcmCameraTest, TimesOutWhenNothingComes) {
  EXPECT_EQ(camera_->grab(frame_, kNoWait), GrabStatus::kTimeout);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(camera_->grab(frame_, kShort), GrabStatus::kTimeout);
  EXPECT_GE(std::chrono::steady_clock::now() - start, kShort);
}

TEST_F(LcmCameraTest, CountsGaps) {
  for (const int number : {1, 2, 5, 6}) send(image(number));
  for (const int number : {1, 2, 5, 6}) expect_frame(number);
  EXPECT_EQ(camera_->counters().dropped, 2U);
}

TEST_F(LcmCameraTest, CountsNoGapWhenTheSenderStartsAnew) {
  send(image(7));
  expect_frame(7);
  Bus other_bus(options_.provider_url);
  Publisher<image_t> other(other_bus, options_.channel);
  image_t first = image(12);
  ASSERT_TRUE(other.publish(first));
  expect_frame(12);
  EXPECT_EQ(camera_->counters().dropped, 0U);
}

TEST_F(LcmCameraTest, CountsAndPassesOverWhatIsWrong) {
  image_t too_wide = image(1);
  too_wide.width = 20'000;
  image_t lying = image(2);
  lying.height = kHeight + 1;  // not what its JPEG turns out to be
  image_t cut = image(3);
  cut.data.resize(cut.data.size() / 2);
  cut.size = static_cast<std::int32_t>(cut.data.size());
  image_t unknown = image(4);
  unknown.pixel_format = 77;
  image_t early = image(5);
  early.timestamp_ns += 60'000'000'000;
  image_t late = image(6);
  late.timestamp_ns -= 60'000'000'000;
  for (const image_t& wrong : {too_wide, lying, cut, unknown, early, late}) send(wrong);
  request_t request{};
  ASSERT_TRUE(Publisher<request_t>(*sender_, options_.channel).publish(request));
  send(image(7));
  expect_frame(7);
  EXPECT_EQ(camera_->counters().malformed, 7U);
  EXPECT_EQ(camera_->counters().received, 1U);
}

TEST_F(LcmCameraTest, HandsOnStampsOfAnyClockWhereThatIsWanted) {
  options_.any_clock = true;
  camera_.emplace(options_);
  ASSERT_EQ(camera_->open(), std::nullopt);
  image_t other_host = image(1);
  other_host.timestamp_ns = 77;
  image_t back = image(2);
  back.timestamp_ns = 76;
  image_t nonsense = image(3);
  nonsense.timestamp_ns = std::numeric_limits<std::int64_t>::min();
  for (const image_t& sent : {other_host, back, nonsense, image(4)}) send(sent);
  expect_frame(1);
  EXPECT_EQ(frame_.timestamp_ns, 77);
  expect_frame(2);
  expect_frame(4);
  EXPECT_EQ(camera_->counters().malformed, 1U);
}

TEST_F(LcmCameraTest, PassesOverImagesThatGoBackInTime) {
  const image_t first = image(1);
  const image_t second = image(2);
  send(second);
  send(first);
  send(image(3));
  expect_frame(2);
  expect_frame(3);
  EXPECT_EQ(camera_->counters().malformed, 1U);
}

TEST_F(LcmCameraTest, SurvivesFalseLengths) {
  image_t lying = image(1);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(lying.getEncodedSize()));
  lying.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  for (std::size_t i = 64; i < 68; ++i) bytes[i] = 0xFF;  // size: -1
  ASSERT_EQ(
      sender_->lcm().publish(options_.channel, bytes.data(), static_cast<unsigned>(bytes.size())),
      0);
  send(image(2));
  expect_frame(2);
  EXPECT_EQ(camera_->counters().malformed, 1U);
}

TEST_F(LcmCameraTest, AccountsForEveryImageOfABurst) {
  constexpr int kSent = 12;
  for (int number = 1; number <= kSent; ++number) send(image(number));
  for (int number = 1; number <= kSent; ++number) {
    ASSERT_EQ(camera_->grab(frame_, kPatient), GrabStatus::kFrame);
    if (frame_.sequence == kSent) break;
  }
  const CameraCounters counters = camera_->counters();
  EXPECT_EQ(counters.received + counters.dropped_queue, static_cast<std::uint64_t>(kSent));
  EXPECT_EQ(counters.dropped, 0U);
}

TEST_F(LcmCameraTest, DescribesWhatItHears) {
  EXPECT_EQ(camera_->description(), "LCM channel HANDEYE_FRAME, nothing heard yet");
  image_t sent = image(0);
  const std::int64_t start_ns = sent.timestamp_ns;
  for (int number = 1; number <= 5; ++number) {
    sent = image(number);
    sent.timestamp_ns = start_ns + 40'000'000 * number;
    send(sent);
    expect_frame(number);
  }
  EXPECT_EQ(camera_->description(), "LCM channel HANDEYE_FRAME 64x48 JPEG 25.0 Hz");
}

TEST_F(LcmCameraTest, ForgetsTheStreamWhenClosedButNotItsCounters) {
  send(image(1));
  expect_frame(1);
  camera_->close();
  EXPECT_EQ(camera_->grab(frame_, kNoWait), GrabStatus::kLost);
  send(image(4));
  ASSERT_EQ(camera_->open(), std::nullopt);
  send(image(9));
  expect_frame(9);
  EXPECT_EQ(camera_->counters().received, 2U);
  EXPECT_EQ(camera_->counters().dropped, 0U);
  EXPECT_EQ(camera_->counters().opened, 2U);
}

TEST(LcmCamera, SaysWhyItCannotOpen) {
  LcmCameraOptions options;
  options.provider_url = "udpm://10.0.0.1:7667";
  LcmCamera camera(options);
  const std::optional<std::string> problem = camera.open();
  ASSERT_TRUE(problem);
  EXPECT_THAT(*problem, testing::HasSubstr("not a multicast address"));
  Frame frame;
  EXPECT_EQ(camera.grab(frame, kNoWait), GrabStatus::kLost);
  EXPECT_EQ(camera.counters().opened, 0U);
}

}  // namespace
}  // namespace handeye
