// SPDX-License-Identifier: BSD-3-Clause
// A message type's fingerprint changes with any of its fields, and with it programs of different
// versions no longer understand each other, nor recordings made before. So a change must be meant:
// then raise request_t.VERSION, tell it in the change log, and write the new fingerprints here.
#include <cstdint>
#include <iterator>
#include <set>

#include <gtest/gtest.h>
#include <handeye/body_t.hpp>
#include <handeye/camera_pose_t.hpp>
#include <handeye/clock_status_t.hpp>
#include <handeye/datagram_t.hpp>
#include <handeye/device_status_t.hpp>
#include <handeye/image_t.hpp>
#include <handeye/method_result_t.hpp>
#include <handeye/request_t.hpp>
#include <handeye/result_t.hpp>
#include <handeye/status_t.hpp>
#include <handeye/tracker_frame_t.hpp>

namespace handeye {
namespace {

struct TypeFingerprint {
  const char* type;
  std::int64_t actual;
  std::uint64_t frozen;
};

// Of protocol version 5.
const TypeFingerprint kFingerprints[] = {
    {"body_t", body_t::getHash(), 0x0459e98b91cec78c},
    {"camera_pose_t", camera_pose_t::getHash(), 0xf8ff33438e8861ac},
    {"clock_status_t", clock_status_t::getHash(), 0xe60f44d345892547},
    {"datagram_t", datagram_t::getHash(), 0x1e4752c4e2527296},
    {"device_status_t", device_status_t::getHash(), 0xfb7c347269e4c01a},
    {"image_t", image_t::getHash(), 0xcceab2c397803b46},
    {"method_result_t", method_result_t::getHash(), 0x8c6cd0142c213234},
    {"request_t", request_t::getHash(), 0xbe8a71a4b093a7a1},
    {"result_t", result_t::getHash(), 0xb6a2dae136392a24},
    {"status_t", status_t::getHash(), 0x0f471e542db810c1},
    {"tracker_frame_t", tracker_frame_t::getHash(), 0x6ef6fc1d940d7e44},
};

TEST(MessageTypes, AreThoseOfTheirProtocolVersion) {
  EXPECT_EQ(request_t::VERSION, 5) << "write the fingerprints of the new version into the table";
  for (const TypeFingerprint& fingerprint : kFingerprints) {
    EXPECT_EQ(static_cast<std::uint64_t>(fingerprint.actual), fingerprint.frozen)
        << fingerprint.type << ".lcm has changed: programs and recordings of before will not "
        << "understand it. If that is meant, see the head of this test.";
  }
}

TEST(MessageTypes, CanBeToldApart) {
  std::set<std::int64_t> distinct;
  for (const TypeFingerprint& fingerprint : kFingerprints) distinct.insert(fingerprint.actual);
  EXPECT_EQ(distinct.size(), std::size(kFingerprints));
}

}  // namespace
}  // namespace handeye
