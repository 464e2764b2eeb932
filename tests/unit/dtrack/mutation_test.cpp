// SPDX-License-Identifier: BSD-3-Clause
// Properties under random damage: nothing crashes, and a line is in the frame wholly or not at all.
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

/// How many targets each line of full_frame.txt put into the frame.
std::vector<std::size_t> list_sizes(const Frame& frame) {
  return {frame.bodies.size(), frame.covariances.size(),     frame.flysticks.size(),
          frame.tools.size(),  frame.tool_references.size(), frame.markers.size(),
          frame.hands.size(),  frame.humans.size()};
}

/// Of any accepted datagram, whatever was in it.
void assert_sound(const Frame& frame) {
  for (const Body& body : frame.bodies) {
    const Eigen::Matrix3d rotation = body.room_from_body.linear();
    RC_ASSERT(body.room_from_body.matrix().allFinite());
    RC_ASSERT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < 1e-5);
    RC_ASSERT(frame.find_body(body.id) == &body);
  }
  for (const BodyCovariance& covariance : frame.covariances) {
    RC_ASSERT(covariance.covariance.allFinite());
    RC_ASSERT(frame.find_body(covariance.id) != nullptr);
  }
  for (const Marker& marker : frame.markers) RC_ASSERT(marker.position_mm.allFinite());
  for (const FingertrackingHand& hand : frame.hands) {
    RC_ASSERT(hand.fingers.size() == 3U || hand.fingers.size() == 5U);
  }
  RC_ASSERT(!frame.seconds_of_day ||
            (*frame.seconds_of_day >= 0 && *frame.seconds_of_day < 86'400));
  RC_ASSERT(!frame.calibrated_bodies || *frame.calibrated_bodies >= 0);
}

void check(const std::string& description, const std::function<void()>& property) {
  setenv("RC_PARAMS", "seed=20 max_success=2000", 0);  // the environment may ask for others
  EXPECT_TRUE(rc::check(description, property));
}

TEST(DTrackMutation, TruncationKeepsWholeLinesOnly) {
  const std::string full = sample("full_frame.txt");
  const auto sizes = list_sizes(Parsed(full).frame);
  check("each list is whole or empty", [&] {
    const auto length = *rc::gen::inRange<std::size_t>(0, full.size());
    // A copy of just these bytes, so that a sanitizer sees any read behind them.
    const std::vector<char> bytes(full.begin(), full.begin() + static_cast<std::ptrdiff_t>(length));
    const Parsed parsed(std::string_view(bytes.data(), bytes.size()));
    if (parsed.status == ParseStatus::kRejected) {
      RC_ASSERT(length < sample("fr.txt").size());
      return;
    }
    const auto cut_sizes = list_sizes(parsed.frame);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const bool two_of_three_bodies = i == 0 && cut_sizes[i] == 2;  // 6d without 6di
      RC_ASSERT(cut_sizes[i] == 0 || cut_sizes[i] == sizes[i] || two_of_three_bodies);
    }
    assert_sound(parsed.frame);
  });
}

TEST(DTrackMutation, ChangedBytesTouchOnlyTheirLine) {
  check("the other lines are read as before", [] {
    const std::string markers = sample("3d.txt");
    std::string line = sample(*rc::gen::element<std::string>(
        "6d.txt", "6dcov.txt", "6di.txt", "6df.txt", "6df2.txt", "6dmt.txt", "6dmt2.txt",
        "6dmtr.txt", "gl.txt", "6dj.txt", "st.txt", "ts.txt", "ts2.txt", "6dcal.txt"));
    const auto changes = *rc::gen::inRange(1, 4);
    for (int i = 0; i < changes; ++i) {
      const auto at = *rc::gen::inRange<std::size_t>(0, line.size() - 2);  // not its end
      line[at] = *rc::gen::suchThat(
          rc::gen::oneOf(rc::gen::element('[', ']', ' ', '-', '.', ',', '9', 'e', '\t', 'n'),
                         rc::gen::arbitrary<char>()),
          [](char c) { return c != '\0' && c != '\r' && c != '\n'; });
    }
    RC_PRE(!line.starts_with("3d ") && !line.starts_with("fr ") && !line.starts_with("glcal "));
    const Parsed parsed("fr 1\r\n" + markers + line + "glcal 2\r\n");
    RC_ASSERT(parsed.status != ParseStatus::kRejected);
    RC_ASSERT(parsed.frame.markers.size() == 2U);
    RC_ASSERT(parsed.frame.markers[1].position_mm == Eigen::Vector3d(-402, 18.25, 990.375));
    RC_ASSERT(parsed.frame.calibrated_hands == 2);
    assert_sound(parsed.frame);
  });
}

TEST(DTrackMutation, ARefusedLineLeavesWhatAnEarlierOneSaid) {
  check("the first 6d line stands", [] {
    const std::string good = sample("6d.txt");
    const auto length = *rc::gen::inRange<std::size_t>(5, good.size() - 3);
    const Parsed parsed("fr 1\r\n" + good + good.substr(0, length));
    RC_ASSERT(parsed.status == ParseStatus::kPartial);
    RC_ASSERT(parsed.counters().rejected_lines == 1U);
    RC_ASSERT(parsed.frame.bodies.size() == 2U);
    RC_ASSERT(parsed.frame.bodies[0].room_from_body.translation() ==
              Eigen::Vector3d(412.507, -88.25, 1503.125));
  });
}

TEST(DTrackMutation, PiecesOfLinesInAnyOrderNeverCrash) {
  Parser parser;  // one for all, so that memory is reused from anything to anything
  Frame frame;
  const std::string full = sample("full_frame.txt");
  check("whatever comes out is sound", [&] {
    std::string text = "fr 1\r\n";
    const auto pieces = *rc::gen::inRange(1, 12);
    for (int i = 0; i < pieces; ++i) {
      const auto first = *rc::gen::inRange<std::size_t>(0, full.size());
      text += full.substr(first, *rc::gen::inRange<std::size_t>(0, 400));
      if (*rc::gen::arbitrary<bool>()) text += "\r\n";
    }
    if (parser.parse(text, frame) != ParseStatus::kRejected) assert_sound(frame);
  });
}

TEST(DTrackMutation, ArbitraryBytesNeverCrash) {
  Parser parser;
  Frame frame;
  check("whatever comes out is sound", [&] {
    const auto text = *rc::gen::arbitrary<std::string>();
    if (parser.parse("fr 1\n6d " + text, frame) != ParseStatus::kRejected) assert_sound(frame);
    parser.parse(text, frame);
  });
}

}  // namespace
}  // namespace handeye::dtrack
