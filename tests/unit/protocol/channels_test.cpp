// SPDX-License-Identifier: BSD-3-Clause
#include "protocol/channels.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr std::size_t kLcmLongestChannel = 63;

std::set<std::string> all_channels(const Channels& channels) {
  return {channels.request, channels.status, channels.result,  channels.camera_pose,
          channels.tracker, channels.frame,  channels.preview, channels.datagram};
}

TEST(Channels, AreTheDocumentedNames) {
  const Channels channels;
  EXPECT_EQ(channels.request, "HANDEYE_REQUEST");
  EXPECT_EQ(channels.status, "HANDEYE_STATUS");
  EXPECT_EQ(channels.result, "HANDEYE_RESULT");
  EXPECT_EQ(channels.camera_pose, "HANDEYE_CAMERA_POSE");
  EXPECT_EQ(channels.tracker, "HANDEYE_TRACKER");
  EXPECT_EQ(channels.frame, "HANDEYE_FRAME");
  EXPECT_EQ(channels.preview, "HANDEYE_PREVIEW");
  EXPECT_EQ(channels.datagram, "HANDEYE_DATAGRAM");
}

TEST(Channels, CarryTheirPrefixAndDiffer) {
  const std::set<std::string> names = all_channels(Channels("OR2-"));
  EXPECT_EQ(names.size(), 8U);
  for (const std::string& name : names) EXPECT_TRUE(name.starts_with("OR2-")) << name;
}

TEST(Channels, FitIntoLcmWithTheLongestPrefix) {
  const std::string longest(40, 'x');
  ASSERT_TRUE(is_valid_channel_prefix(longest));
  for (const std::string& name : all_channels(Channels(longest))) {
    EXPECT_LE(name.size(), kLcmLongestChannel) << name;
  }
}

TEST(ChannelPrefix, LettersDigitsUnderscoreAndMinus) {
  EXPECT_TRUE(is_valid_channel_prefix(kDefaultChannelPrefix));
  EXPECT_TRUE(is_valid_channel_prefix(""));
  EXPECT_TRUE(is_valid_channel_prefix("azAZ09_-"));
}

TEST(ChannelPrefix, NothingThatARegularExpressionUnderstands) {
  for (int code = 0; code < 256; ++code) {
    const char c = static_cast<char>(code);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-';
    EXPECT_EQ(is_valid_channel_prefix(std::string(1, c)), plain) << code;
  }
  EXPECT_FALSE(is_valid_channel_prefix("ROOM.*"));
}

TEST(ChannelPrefix, AtMostFortyCharacters) {
  EXPECT_TRUE(is_valid_channel_prefix(std::string(40, 'x')));
  EXPECT_FALSE(is_valid_channel_prefix(std::string(41, 'x')));
}

}  // namespace
}  // namespace handeye
