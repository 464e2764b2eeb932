// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/image_rows.hpp"

#include <cmath>

#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

/// What a keyframe's observations have in common.
struct Eye {
  Eigen::Matrix3d eye_from_room;
  Eigen::Vector3d centre_mm;
};

std::vector<Eye> eyes_of(const MetricState& state) {
  std::vector<Eye> eyes;
  eyes.reserve(state.room_from_eye.size());
  for (const Pose& pose : state.room_from_eye) {
    eyes.push_back({pose.linear().transpose(), pose.translation()});
  }
  return eyes;
}

}  // namespace

Matrix26 pixel_by_eye(const ImageRow& row) {
  Matrix26 result;
  result << row.by_point * skew(row.point_from_eye_mm), -row.by_point;
  return result;
}

bool linearise(const MetricScene& scene, const MetricState& state,
               const std::vector<double>& track_weights, double huber_px, bool lens_free,
               ImageRows& rows) {
  if (state.camera.problem()) return false;
  const std::vector<Eye> eyes = eyes_of(state);
  rows.rows.resize(scene.observations.size());
  rows.cost = rows.weighted_squares = rows.squares = 0;
  rows.squares_of_tracks.assign(scene.points(), 0.0);
  for (std::size_t j = 0; j < scene.points(); ++j) {
    const double track_root = std::sqrt(track_weights[j]);
    double of_track = 0;
    for (std::size_t i = scene.first_of_point[j]; i < scene.first_of_point[j + 1]; ++i) {
      const MetricObservation& seen = scene.observations[i];
      const Eye& eye = eyes[seen.keyframe];
      ImageRow& row = rows.rows[i];
      row.point_from_eye_mm = state.points_mm[j] - eye.centre_mm;
      const Eigen::Vector3d point_eye = eye.eye_from_room * row.point_from_eye_mm;
      if (!(point_eye.z() > 0)) return false;
      const Projection projection = project_with_derivative(state.camera, point_eye);
      row.error = projection.pixel - seen.pixel;
      row.by_point.noalias() = projection.by_point_eye * eye.eye_from_room;
      if (lens_free) row.by_lens = pixel_by_lens(state.camera, point_eye);
      const double square = row.error.squaredNorm();
      rows.squares += square;
      double root = track_root;
      const double norm = track_root * std::sqrt(square);
      if (norm > huber_px) {
        rows.cost += huber_px * (norm - 0.5 * huber_px);
        of_track += huber_px * norm;
        root *= std::sqrt(huber_px / norm);
      } else {
        rows.cost += 0.5 * norm * norm;
        of_track += norm * norm;
      }
      row.error *= root;
      row.by_point *= root;
      if (lens_free) row.by_lens *= root;
    }
    rows.weighted_squares += of_track;
    rows.squares_of_tracks[j] = of_track / track_weights[j];
  }
  return std::isfinite(rows.cost);
}

ImageGradient gradient_of(const MetricScene& scene, const ImageRows& rows, bool lens_free) {
  ImageGradient gradient{Eigen::VectorXd::Zero(scene.unknowns()),
                         std::vector<Eigen::Vector3d>(scene.points(), Eigen::Vector3d::Zero())};
  LensVector of_lens = LensVector::Zero();
  for (std::size_t j = 0; j < scene.points(); ++j) {
    for (std::size_t i = scene.first_of_point[j]; i < scene.first_of_point[j + 1]; ++i) {
      const ImageRow& row = rows.rows[i];
      const Eigen::Vector3d pull = row.by_point.transpose() * row.error;
      gradient.of_points[j] += pull;
      const Eigen::Index at = unknowns_of_eye(scene.observations[i].keyframe);
      gradient.of_unknowns.segment<3>(at) -= row.point_from_eye_mm.cross(pull);
      gradient.of_unknowns.segment<3>(at + 3) -= pull;
      if (lens_free) of_lens.noalias() += row.by_lens.transpose() * row.error;
    }
  }
  gradient.of_unknowns.tail<kLensParameters>() = of_lens;
  return gradient;
}

std::vector<double> error_norms(const MetricScene& scene, const MetricState& state) {
  std::vector<double> norms;
  norms.reserve(scene.observations.size());
  for (std::size_t j = 0; j < scene.points(); ++j) {
    for (std::size_t i = scene.first_of_point[j]; i < scene.first_of_point[j + 1]; ++i) {
      const MetricObservation& seen = scene.observations[i];
      const Eigen::Vector3d point_eye =
          state.room_from_eye[seen.keyframe].inverse() * state.points_mm[j];
      norms.push_back((project<double>(state.camera, point_eye) - seen.pixel).norm());
    }
  }
  return norms;
}

}  // namespace handeye
