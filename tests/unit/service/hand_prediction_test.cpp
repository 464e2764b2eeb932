// SPDX-License-Identifier: BSD-3-Clause
// predict_hand against the truth: exact on courses it can follow, honest about all others.
#include "daemon/sync/hand_prediction.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "drivers/simulator/motion.hpp"

namespace handeye {
namespace {

constexpr double kRate_hz = 60;
constexpr std::int64_t kMillisecond_ns = 1'000'000;
const HandSampleNoise kNoise{.rotation_rad = rad_from_deg(0.06), .translation_mm = 0.15};

std::int64_t ns(double time_s) {
  return static_cast<std::int64_t>(std::llround(1e9 * time_s));
}

HandSample sample(double time_s, const Pose& room_from_hand) {
  HandSample result;
  result.timestamp_ns = ns(time_s);
  result.tracked = true;
  result.room_from_hand = room_from_hand;
  return result;
}

HandSample hidden_sample(double time_s) {
  HandSample result;
  result.timestamp_ns = ns(time_s);
  return result;
}

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  Pose of(const Pose& pose, const HandSampleNoise& noise) {
    Pose measured = pose;
    measured.linear() = exp_so3(vector(noise.rotation_rad)) * pose.linear();
    measured.translation() += vector(noise.translation_mm);
    return measured;
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  Eigen::Vector3d vector(double sigma) {
    const double x = normal_(random_);
    const double y = normal_(random_);
    return sigma * Eigen::Vector3d(x, y, normal_(random_));
  }
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

/// Turns and moves with constant acceleration about one axis.
Pose accelerated(double time_s) {
  Pose pose = make_pose(Eigen::Quaterniond(0.3, 0.8, -0.1, 0.5), Eigen::Vector3d(1200, -300, 800));
  const double angle = 0.4 * time_s + 0.3 * time_s * time_s;
  pose.linear() = exp_so3(angle * Eigen::Vector3d(0.6, -0.8, 0)) * pose.linear();
  pose.translation() +=
      Eigen::Vector3d(150, -80, 20) * time_s + Eigen::Vector3d(60, 200, -100) * time_s * time_s;
  return pose;
}

PoseBuffer samples_of(Pose (*pose_at)(double), int count) {
  PoseBuffer buffer;
  for (int i = 0; i < count; ++i) {
    const double time_s = i / kRate_hz;
    buffer.push(sample(time_s, pose_at(time_s)));
  }
  return buffer;
}

TEST(HandPrediction, FollowsAConstantAcceleration) {
  const PoseBuffer buffer = samples_of(accelerated, 12);
  const double at_s = 11 / kRate_hz + 0.05;
  const auto hand = predict_hand(buffer, ns(at_s), kNoise);
  ASSERT_TRUE(hand.has_value());
  EXPECT_LT(hand_movement(hand->room_from_hand, accelerated(at_s)).norm(), 1e-6);
  EXPECT_NEAR(hand->predicted_s, 0.05, 1e-8);
  constexpr double kStep_s = 1e-4;
  const Vector6d rate =
      hand_movement(accelerated(at_s - kStep_s), accelerated(at_s + kStep_s)) / (2 * kStep_s);
  EXPECT_LT((hand->angular_velocity - rate.head<3>()).norm(), 1e-5);
  EXPECT_LT((hand->velocity - rate.tail<3>()).norm(), 1e-4);
}

TEST(HandPrediction, NeverLeansOnWhatWasBeforeAHiddenSample) {
  PoseBuffer hidden = samples_of(accelerated, 12);
  hidden.push(hidden_sample(12 / kRate_hz));
  EXPECT_FALSE(predict_hand(hidden, ns(0.21), kNoise)) << "the newest is hidden";
  // Poses that would show, were they used.
  PoseBuffer reappeared;
  for (int i = 0; i < 6; ++i) reappeared.push(sample(i / kRate_hz, Pose::Identity()));
  reappeared.push(hidden_sample(6 / kRate_hz));
  for (int i = 7; i < 11; ++i) {
    reappeared.push(sample(i / kRate_hz, accelerated(i / kRate_hz)));
    EXPECT_FALSE(predict_hand(reappeared, ns(i / kRate_hz + 0.01), kNoise)) << "too few since";
  }
  reappeared.push(sample(11 / kRate_hz, accelerated(11 / kRate_hz)));
  const double at_s = 11 / kRate_hz + 0.01;
  const auto hand = predict_hand(reappeared, ns(at_s), kNoise);
  ASSERT_TRUE(hand.has_value());
  EXPECT_LT(hand_movement(hand->room_from_hand, accelerated(at_s)).norm(), 1e-6);
}

TEST(HandPrediction, NeverLeansOnWhatWasBeforeAGapOrAClocksJump) {
  for (const bool jump : {false, true}) {
    PoseBuffer buffer;
    for (int i = 0; i < 6; ++i) buffer.push(sample(i / kRate_hz, Pose::Identity()));
    const double after_s = (jump ? 6 : 12) / kRate_hz;
    for (int i = 0; i < 4; ++i) {
      HandSample later = sample(after_s + i / kRate_hz, accelerated(i / kRate_hz));
      if (jump) later.clock_epoch = 1;
      buffer.push(later);
    }
    EXPECT_FALSE(predict_hand(buffer, ns(after_s + 4 / kRate_hz), kNoise)) << jump;
  }
  EXPECT_FALSE(predict_hand(PoseBuffer(), 0, kNoise));
}

TEST(HandPrediction, CovarianceGrowsWithTheHorizon) {
  const PoseBuffer buffer = samples_of(accelerated, 12);
  double before = 0;
  for (int ahead_ms = 1; ahead_ms <= 60; ++ahead_ms) {
    const auto hand = predict_hand(buffer, ns(11 / kRate_hz) + ahead_ms * kMillisecond_ns, kNoise);
    ASSERT_TRUE(hand.has_value());
    const double now = hand->covariance.bottomRightCorner<3, 3>().trace();
    EXPECT_GT(now, before) << ahead_ms << " ms";
    before = now;
  }
}

TEST(HandPrediction, TakesASamplesOwnCovariance) {
  const Pose still = accelerated(0);
  PoseBuffer plain;
  PoseBuffer with_own;
  for (int i = 0; i < 12; ++i) {
    HandSample still_sample = sample(i / kRate_hz, still);
    plain.push(still_sample);
    still_sample.covariance = (4 * hand_sample_covariance(kNoise)).cast<float>();
    with_own.push(still_sample);
  }
  const std::int64_t at_ns = ns(11 / kRate_hz) + 20 * kMillisecond_ns;
  const auto one = predict_hand(plain, at_ns, kNoise);
  const auto other = predict_hand(with_own, at_ns, kNoise);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(other->covariance(i, i) / one->covariance(i, i), 4, 1e-4) << i;
  }
}

/// Errors of many predictions against what was claimed.
struct Nees {
  double rotation{0}, translation{0}, rotation_square{0}, translation_square{0};
  int count{0};

  void add(const Vector6d& error, const Matrix6d& covariance) {
    const Eigen::Matrix3d rotation_block = covariance.topLeftCorner<3, 3>();
    const Eigen::Matrix3d translation_block = covariance.bottomRightCorner<3, 3>();
    rotation += error.head<3>().dot(rotation_block.llt().solve(error.head<3>()));
    translation += error.tail<3>().dot(translation_block.llt().solve(error.tail<3>()));
    rotation_square += error.head<3>().squaredNorm();
    translation_square += error.tail<3>().squaredNorm();
    ++count;
  }
  double mean_rotation() const { return rotation / count; }
  double mean_translation() const { return translation / count; }
  std::string text() const {
    std::ostringstream out;
    out << "NEES " << mean_rotation() << " and " << mean_translation() << " (3 is right), rms "
        << deg_from_rad(std::sqrt(rotation_square / count / 3)) << " deg and "
        << std::sqrt(translation_square / count / 3) << " mm per axis";
    return out.str();
  }
};

/// Predictions on the simulator's free-hand motion, `speed` times as fast; the hand is 300 mm
/// behind the eye. `history_s`: how long it has been seen.
Nees on_simulated_motion(double speed, double ahead_s, double history_s = 0.8) {
  constexpr int kMotions = 20;
  constexpr int kDraws = 40;
  const Pose eye_from_hand =
      make_pose(Eigen::Quaterniond(0.3, 0.8, -0.1, 0.5), Eigen::Vector3d(30, 20, -300));
  Nees nees;
  Noise noise(11);
  for (std::uint64_t seed = 0; seed < kMotions; ++seed) {
    const simulator::Motion motion(seed, Eigen::Vector3d::Zero());
    const auto hand_at = [&](double time_s) {
      return motion.surface_from_eye(speed * time_s) * eye_from_hand;
    };
    for (int draw = 0; draw < kDraws; ++draw) {
      const double newest_s = noise.uniform(1, 60);
      PoseBuffer buffer({.capacity = 64});
      for (int i = static_cast<int>(history_s * kRate_hz); i >= 0; --i) {
        const double time_s = newest_s - i / kRate_hz;
        buffer.push(sample(time_s, noise.of(hand_at(time_s), kNoise)));
      }
      const auto hand = predict_hand(buffer, ns(newest_s + ahead_s), kNoise);
      if (!hand) continue;
      nees.add(hand_movement(hand->room_from_hand, hand_at(newest_s + ahead_s)), hand->covariance);
    }
  }
  return nees;
}

/// Mean of `count` squares of 3 normal variables: its 99.9 % band ends there.
double upper_band(int count) {
  return 3 + 3.3 * std::sqrt(6.0 / count);
}

TEST(HandPrediction, IsHonestOnSimulatedMotion) {
  for (const double speed : {0.0, 1.0, 2.0, 3.0}) {
    for (const double ahead_s : {0.005, 0.02, 0.06}) {
      const Nees nees = on_simulated_motion(speed, ahead_s);
      SCOPED_TRACE(fmt::format("speed {}, {} ms: {}", speed, 1e3 * ahead_s, nees.text()));
      std::cout << "speed " << speed << ", " << 1e3 * ahead_s << " ms: " << nees.text() << '\n';
      ASSERT_EQ(nees.count, 800);
      EXPECT_LT(nees.mean_rotation(), upper_band(nees.count)) << "bold";
      EXPECT_LT(nees.mean_translation(), upper_band(nees.count)) << "bold";
      EXPECT_GT(nees.mean_rotation(), 1.5) << "timid: the claim is 1.4 times the error";
      EXPECT_GT(nees.mean_translation(), 1.5) << "timid";
    }
  }
}

TEST(HandPrediction, IsNotBoldJustAfterTheHandReappeared) {
  for (const double speed : {0.0, 1.0, 3.0}) {
    for (const double ahead_s : {0.02, 0.06}) {
      const Nees nees = on_simulated_motion(speed, ahead_s, 0.1);
      SCOPED_TRACE(fmt::format("speed {}, {} ms: {}", speed, 1e3 * ahead_s, nees.text()));
      ASSERT_EQ(nees.count, 800);
      EXPECT_LT(nees.mean_rotation(), upper_band(nees.count));
      EXPECT_LT(nees.mean_translation(), upper_band(nees.count));
    }
  }
}

TEST(HandPrediction, IsMoreAccurateThanTheNewestSampleOnSimulatedMotion) {
  const Nees nees = on_simulated_motion(1, 0.04);
  // A pose that is 40 ms old is behind by 0.8 deg and 5 mm per axis.
  EXPECT_LT(deg_from_rad(std::sqrt(nees.rotation_square / nees.count / 3)), 0.13);
  EXPECT_LT(std::sqrt(nees.translation_square / nees.count / 3), 0.33);
}

/// A camera that was carried about by hand, seen by Vicon at 100 Hz; noise is added.
std::vector<HandSample> real_samples(const std::filesystem::path& file) {
  std::vector<HandSample> samples;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    double time_s = 0;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    if (!(words >> time_s >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w())) continue;
    constexpr double kEpoch_s = 1491754000;
    samples.push_back(sample(time_s - kEpoch_s, make_pose(q, 1e3 * t)));
  }
  return samples;
}

/// Every sixth sample's prediction from those up to `ahead` samples before it.
Nees on_real_motion(const std::vector<HandSample>& truth, std::size_t ahead) {
  Nees nees;
  Noise noise(5);
  PoseBuffer buffer({.capacity = 128});
  for (std::size_t i = 0; i + ahead < truth.size(); ++i) {
    HandSample measured = truth[i];
    measured.room_from_hand = noise.of(measured.room_from_hand, kNoise);
    buffer.push(measured);
    const HandSample& wanted = truth[i + ahead];
    const auto late_ms = (wanted.timestamp_ns - measured.timestamp_ns) / kMillisecond_ns;
    if (i % 6 != 0 || late_ms > 10 * static_cast<std::int64_t>(ahead) + 2) continue;
    const auto hand = predict_hand(buffer, wanted.timestamp_ns, kNoise);
    if (!hand) continue;
    nees.add(hand_movement(hand->room_from_hand, wanted.room_from_hand), hand->covariance);
  }
  return nees;
}

TEST(HandPrediction, IsHonestOnARealHand) {
  const char* configured = std::getenv("HANDEYE_DATA");
  const std::filesystem::path folder =
      configured != nullptr ? configured : HANDEYE_SOURCE_DIR "/../shared/data";
  const std::filesystem::path file = folder / "streams/vicon_hand.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const std::vector<HandSample> truth = real_samples(file);
  ASSERT_GT(truth.size(), 7000U);
  for (const std::size_t ahead : {2U, 4U, 6U}) {
    const Nees nees = on_real_motion(truth, ahead);
    SCOPED_TRACE(nees.text());
    std::cout << 10 * ahead << " ms: " << nees.text() << '\n';
    EXPECT_GT(nees.count, 1000);
    // Errors of one second go together, so that the band of so many draws does not apply.
    EXPECT_LT(nees.mean_rotation(), 4);
    EXPECT_LT(nees.mean_translation(), 4);
    EXPECT_GT(nees.mean_rotation(), 1.5);
    EXPECT_GT(nees.mean_translation(), 1.5);
  }
}

}  // namespace
}  // namespace handeye
