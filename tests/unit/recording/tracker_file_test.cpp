// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/tracker_file.hpp"

#include <gtest/gtest.h>

#include "tests/unit/recording/expect_input_error.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

class TrackerFile : public testing::Test {
 protected:
  std::vector<RecordedDatagram> read(const std::string& text) {
    write_bytes(path_, text);
    return read_tracker_file(path_);
  }
  void expect_refused(const std::string& text, const std::initializer_list<std::string>& words) {
    expect_input_error([&] { read(text); }, words);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "tracker.txt";
};

TEST_F(TrackerFile, ReadsRawBytes) {
  const auto datagrams = read("@ 5 4\n@\n\n@\n@ 5 0\n\n@ 9223372036854775807 2\nfr\n");
  ASSERT_EQ(datagrams.size(), 3U);
  EXPECT_EQ(datagrams[0].bytes, "@\n\n@");
  EXPECT_EQ(datagrams[1].arrival_ns, 5);
  EXPECT_EQ(datagrams[1].bytes, "");
  EXPECT_EQ(datagrams[2].arrival_ns, std::numeric_limits<std::int64_t>::max());
}

TEST_F(TrackerFile, MayBeEmpty) {
  EXPECT_TRUE(read("").empty());
}

TEST_F(TrackerFile, IsRefusedWhereverItIsCut) {
  const std::string text = "@ 5 4\nfr 1\n@ 6 6\nfr 2\r\n\n";
  const std::size_t first_end = text.find("@ 6");
  for (std::size_t length = 1; length < text.size(); ++length) {
    if (length == first_end) continue;
    expect_refused(
        text.substr(0, length),
        {"tracker.txt", length < first_end ? "datagram 1 at byte 0" : "datagram 2 at byte 11"});
  }
}

TEST_F(TrackerFile, RefusesFalseHeaders) {
  for (const std::string header :
       {"5 2", "@5 2", "@ 5", "@ 5 2 ", "@  5 2", "@ x 2", "@ 5 -2", "@ -5 2", "@ 5 2x", "@ 5.0 2",
        "@ 5 65508", "@ 99999999999999999999 2"}) {
    expect_refused(header + "\nfr\n", {"datagram 1 at byte 0", "ARRIVAL_NS"});
  }
}

TEST_F(TrackerFile, RefusesAByteCountThatIsWrong) {
  expect_refused("@ 5 1\nfr\n@ 6 2\nfr\n", {"datagram 1", "byte count"});
}

TEST_F(TrackerFile, RefusesToGoBackInTime) {
  expect_refused("@ 5 2\nfr\n@ 4 2\nfr\n", {"datagram 2 at byte 9", "before"});
}

}  // namespace
}  // namespace handeye
