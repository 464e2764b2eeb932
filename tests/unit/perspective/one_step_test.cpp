// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/one_step.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "daemon/handeye/perspective/lens.hpp"
#include "tests/unit/perspective/chung_simulation.hpp"

namespace handeye {
namespace {

using namespace test;

PerspectiveCalibration solved(const Observations& observations,
                              const PerspectiveOptions& options = {}) {
  const auto found = calibrate_perspective(observations, options);
  if (const auto* refusal = std::get_if<PerspectiveRefusal>(&found)) {
    throw std::runtime_error("refused: " + refusal->advice);
  }
  return std::get<PerspectiveCalibration>(found);
}

std::string refusal(const Observations& observations) {
  const auto found = calibrate_perspective(observations, {});
  const auto* refused = std::get_if<PerspectiveRefusal>(&found);
  return refused == nullptr ? "" : refused->reason;
}

/// An endoscope-like scene: 8 positions, +-20 deg, object of about 60 mm, 120 mm away; Y is a
/// rotation by `y_angle_deg`.
struct Scene {
  Pose hand_from_eye{make_pose({0.8, 0.3, -0.2, 0.5}, {-30, 5, -280})};
  Pose object_from_hand;
  SensorLens lens{.pixel_mm = {0.003, 0.003}, .centre_px = {330, 250}, .k1_per_mm2 = 0.02};
  double focal_mm{2.1};
  double anamorphic{1.0};  ///< focal length in x over that in y
  std::vector<Pose> hand1_from_hands;
  Observations observations{.width = 640, .height = 480, .pixel_mm = {0.003, 0.003}};

  explicit Scene(bool planar, double y_angle_deg = 140.0, int positions = 8, unsigned seed = 3) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.8, 0.5).normalized();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(rad_from_deg(y_angle_deg), axis));
    // The camera looks at the middle of the object, 120 mm away.
    object_from_hand = make_pose(turn, {0, 0, 0});
    const Eigen::Vector3d middle(25, 25, planar ? 0 : 12);
    const Eigen::Vector3d seen = object_from_hand * (hand_from_eye * Eigen::Vector3d(0, 0, 120));
    object_from_hand.translation() = middle - seen;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < positions; ++i) {
      Pose eye1_from_eye = Pose::Identity();
      if (i > 0) {
        // Turns about the middle of what it looks at, and shifts.
        const Eigen::Vector3d target(0, 0, 120);
        eye1_from_eye.linear() = exp_so3(rad_from_deg(20.0) * vector());
        eye1_from_eye.translation() = target - eye1_from_eye.linear() * target + 15.0 * vector();
      }
      const Pose hand1_from_hand = hand_from_eye * eye1_from_eye * hand_from_eye.inverse();
      hand1_from_hands.push_back(hand1_from_hand);
      add_position(hand1_from_hand, planar);
    }
  }

  void add_position(const Pose& hand1_from_hand, bool planar) {
    ObservedPosition position{.hand1_from_hand = hand1_from_hand};
    const Pose eye_from_object = (object_from_hand * hand1_from_hand * hand_from_eye).inverse();
    for (int x = 0; x < 6; ++x) {
      for (int y = 0; y < 6; ++y) {
        const Eigen::Vector3d point(10.0 * x, 10.0 * y, planar ? 0.0 : 12.0 * ((x + 2 * y) % 3));
        Eigen::Vector2d image = focal_mm * (eye_from_object * point).hnormalized();
        image.x() *= anamorphic;
        position.points.push_back({point, distorted_pixel(lens, image)});
      }
    }
    observations.positions.push_back(std::move(position));
  }

  Scene& with_image_noise(double sigma_px, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, sigma_px);
    for (ObservedPosition& position : observations.positions) {
      for (ObjectPoint& point : position.points) {
        point.pixel += Eigen::Vector2d(noise(random), noise(random));
      }
    }
    return *this;
  }

  Scene& with_hand_noise(double sigma_deg, double sigma_mm, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    const auto vector = [&] {
      return Eigen::Vector3d(noise(random), noise(random), noise(random));
    };
    for (ObservedPosition& position : observations.positions) {
      Pose error = Pose::Identity();
      error.linear() = exp_so3(rad_from_deg(sigma_deg) * vector());
      error.translation() = sigma_mm * vector();
      position.hand1_from_hand = position.hand1_from_hand * error;
    }
    const Pose first = observations.positions.front().hand1_from_hand.inverse();
    for (ObservedPosition& position : observations.positions) {
      position.hand1_from_hand = first * position.hand1_from_hand;
    }
    return *this;
  }
};

void expect_exact(const Scene& scene) {
  const PerspectiveCalibration result = solved(scene.observations);
  const RefinedCalibration& found = result.refined;
  EXPECT_LT(rotation_angle_rad(found.hand_from_eye.linear(), scene.hand_from_eye.linear()), 1e-7);
  EXPECT_LT((found.hand_from_eye.translation() - scene.hand_from_eye.translation()).norm(), 1e-5);
  EXPECT_LT(rotation_angle_rad(found.object_from_hand.linear(), scene.object_from_hand.linear()),
            1e-7);
  EXPECT_LT((found.object_from_hand.translation() - scene.object_from_hand.translation()).norm(),
            1e-5);
  EXPECT_NEAR(found.camera.fx, 700.0, 1e-4);
  EXPECT_NEAR(found.camera.fy, 700.0, 1e-4);
  EXPECT_NEAR(found.camera.cx, 330.0, 1e-4);
  EXPECT_NEAR(found.camera.cy, 250.0, 1e-4);
  EXPECT_NEAR(found.camera.k1_per_mm2, 0.02, 1e-7);
  EXPECT_LT(found.reprojection_px, 1e-7);
  EXPECT_GT(result.iterations, 0);
}

TEST(OneStep, IsExactOnA3dObject) {
  expect_exact(Scene(false));
}

TEST(OneStep, IsExactOnAPlane) {
  expect_exact(Scene(true));
}

TEST(OneStep, ThreePositionsAreEnough) {
  expect_exact(Scene(false, 140.0, 3));
  expect_exact(Scene(true, 140.0, 3));
}

TEST(OneStep, IsExactAtAndAroundHalfATurn) {
  for (const double angle_deg : {0.0, 90.0, 179.0, 179.999999, 180.0, 180.5}) {
    SCOPED_TRACE(angle_deg);
    expect_exact(Scene(false, angle_deg));
  }
}

TEST(OneStep, AnswersThePapersSimulationExactly) {
  const PerspectiveCalibration result = solved(chung::observe({}));
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const auto y = chung::y_vector(result.refined.object_from_hand);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << i;
  EXPECT_LE(result.iterations, 6);
  EXPECT_NEAR(result.refined.camera.k1_per_mm2 / chung::kK1_per_mm2, 1.0, 1e-6);
}

TEST(OneStep, ANoisyFirstGuessOfTheRestIsReplacedByTheStartGiven) {
  PerspectiveOptions options;
  options.start.object_from_hand =
      chung::pose_of(0.75 * chung::y_vector(chung::object_from_hand()));
  options.start.k1_per_mm2 = 0.75 * chung::kK1_per_mm2;
  options.start.centre_px = 0.75 * chung::lens().centre_px;
  options.start.matrices = chung::matrices();
  for (PerspectiveMatrix& matrix : options.start.matrices) matrix(0, 0) *= 0.9;
  const PerspectiveCalibration result = solved(chung::observe({}), options);
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const auto y = chung::y_vector(result.refined.object_from_hand);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << i;
  EXPECT_LE(result.iterations, 6);
}

TEST(OneStep, IgnoringTheDistortionShowsInTheResiduals) {
  const Scene scene(false);
  const PerspectiveCalibration ignored = solved(scene.observations, {.distortion_inside = false});
  EXPECT_EQ(ignored.refined.camera.k1_per_mm2, 0.0);
  EXPECT_EQ(ignored.sigma.camera.k1_per_mm2, 0.0);
  EXPECT_GT(ignored.refined.reprojection_px, 0.1);
}

TEST(OneStep, FindsTheWidthOfAPixelThatIsKnownByItsNameOnly) {
  for (const double factor : {1.011, 0.95}) {
    Observations observations = chung::observe({});
    observations.pixel_mm.x() *= factor;
    const PerspectiveCalibration result = solved(observations);
    const auto ideal = chung::y_vector(chung::object_from_hand());
    const auto y = chung::y_vector(result.refined.object_from_hand);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << i;
    EXPECT_NEAR(result.pixel_mm.x() / chung::pixel_mm().x(), 1.0, 1e-6);
    EXPECT_NEAR(result.refined.camera.k1_per_mm2 / chung::kK1_per_mm2, 1.0, 1e-6);
  }
}

TEST(OneStep, KeepsTheWidthOfAPixelThatIsRight) {
  // A lens that is not round: twice as long a focal length in x.
  Scene scene(false);
  scene.observations.positions.clear();
  scene.anamorphic = 2.0;
  for (const Pose& hand : scene.hand1_from_hands) scene.add_position(hand, false);
  const PerspectiveCalibration result = solved(scene.observations);
  EXPECT_EQ(result.pixel_mm, scene.observations.pixel_mm);
  EXPECT_NEAR(result.refined.camera.fx / result.refined.camera.fy, 2.0, 1e-8);
  EXPECT_LT((result.refined.hand_from_eye.translation() - scene.hand_from_eye.translation()).norm(),
            1e-5);
}

/// Mean of (error / sigma)^2 over seeds: 1 when the sigmas are honest. Errors of hand_from_eye's
/// rotation and translation, whose sigmas are square roots of traces.
Eigen::Vector2d mean_square_errors(bool planar, double image_px, double hand_deg, double hand_mm,
                                   unsigned seeds) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (unsigned seed = 0; seed < seeds; ++seed) {
    Scene scene(planar, 140.0, 8);
    scene.with_image_noise(image_px, seed);
    if (hand_mm > 0) scene.with_hand_noise(hand_deg, hand_mm, 1000 + seed);
    const PerspectiveCalibration result = solved(scene.observations);
    const Pose& found = result.refined.hand_from_eye;
    const double rotation =
        deg_from_rad(rotation_angle_rad(found.linear(), scene.hand_from_eye.linear()));
    const double translation = (found.translation() - scene.hand_from_eye.translation()).norm();
    sum += Eigen::Vector2d(std::pow(rotation / result.sigma.hand_from_eye_deg, 2),
                           std::pow(translation / result.sigma.hand_from_eye_mm, 2));
  }
  return sum / seeds;
}

TEST(OneStep, SigmasAreHonestUnderImageNoise) {
  for (const bool planar : {false, true}) {
    const Eigen::Vector2d ratio = mean_square_errors(planar, 0.3, 0.0, 0.0, 30);
    EXPECT_GT(ratio.minCoeff(), 0.5) << ratio.transpose();
    EXPECT_LT(ratio.maxCoeff(), 1.8) << ratio.transpose();
  }
}

TEST(OneStep, SigmasAreHonestUnderATrackersNoise) {
  const Eigen::Vector2d ratio = mean_square_errors(false, 0.3, 0.06, 0.15, 20);
  EXPECT_GT(ratio.minCoeff(), 0.4) << ratio.transpose();
  EXPECT_LT(ratio.maxCoeff(), 2.2) << ratio.transpose();
}

TEST(OneStep, FewerThanThreePositionsAreRefused) {
  Scene scene(false);
  scene.observations.positions.resize(2);
  EXPECT_EQ(refusal(scene.observations), "too_few_positions");
  scene.observations.positions.clear();
  EXPECT_EQ(refusal(scene.observations), "too_few_positions");
}

TEST(OneStep, TooFewPointsAreRefused) {
  Scene scene(false);
  scene.observations.positions[2].points.resize(5);
  EXPECT_EQ(refusal(scene.observations), "too_few_points");
  Scene plane(true);
  plane.observations.positions[1].points.resize(3);
  EXPECT_EQ(refusal(plane.observations), "too_few_points");
  plane = Scene(true);
  plane.observations.positions[1].points.resize(6);  // one row of the board
  EXPECT_EQ(refusal(plane.observations), "too_few_points");
}

TEST(OneStep, MotionThatDoesNotDetermineItIsRefused) {
  const auto moved = [](const std::vector<Pose>& hands) {
    Scene scene(false, 140.0, 1);
    for (const Pose& hand : hands) scene.add_position(hand, false);
    return scene.observations;
  };
  const Pose still = Pose::Identity();
  EXPECT_EQ(refusal(moved({still, still})), "insufficient_rotation");
  EXPECT_EQ(
      refusal(moved({make_pose({1, 0, 0, 0}, {5, 0, 0}), make_pose({1, 0, 0, 0}, {0, 9, 0})})),
      "insufficient_rotation");
  const auto about_x = [](double angle_deg) {
    Pose pose = Pose::Identity();
    pose.linear() = exp_so3(Eigen::Vector3d(rad_from_deg(angle_deg), 0, 0));
    return pose;
  };
  EXPECT_EQ(refusal(moved({about_x(3), about_x(-4), about_x(5)})), "single_axis");
}

TEST(OneStep, HandPosesTheWrongWayRoundAreNoCalibration) {
  Scene scene(false);
  for (ObservedPosition& position : scene.observations.positions) {
    position.hand1_from_hand = position.hand1_from_hand.inverse();
  }
  EXPECT_NE(refusal(scene.observations), "");
}

TEST(OneStep, AMirroredImageIsRefused) {
  Scene scene(false);
  for (ObservedPosition& position : scene.observations.positions) {
    for (ObjectPoint& point : position.points) point.pixel.y() = 480.0 - point.pixel.y();
  }
  EXPECT_NE(refusal(scene.observations), "");
}

}  // namespace
}  // namespace handeye
