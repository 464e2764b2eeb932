// SPDX-License-Identifier: BSD-3-Clause
// Chung: Table 2 beside ours, and the data of Figures 4 to 6. Usage: papers_chung FOLDER
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "daemon/handeye/perspective/gauss_newton.hpp"
#include "tests/unit/perspective/chung_simulation.hpp"

namespace {

using namespace handeye;
using namespace handeye::test;
using chung::YVector;

YVector ideal() {
  return chung::y_vector(chung::object_from_hand());
}

void print_row(const std::string& name, const YVector& y) {
  fmt::print("| {} | {:.4f} | {:.4f} | {:.5f} | {:.3f} | {:.4f} | {:.2f} |\n", name, y(0), y(1),
             y(2), y(3), y(4), y(5));
}

/// The matrix method on matrices that know nothing of the distortion.
YVector distortion_ignored(const chung::CalibrationObject& object) {
  const Observations observations = chung::observe(object);
  SensorLens lens = chung::lens();
  lens.k1_per_mm2 = 0.0;
  const auto matrices = matrices_by_dlt(observations, lens);
  if (!matrices) throw std::runtime_error("the object determines no perspective matrices");
  const auto found =
      matrix_method(matrix_positions(observations, *matrices), chung::object_from_hand());
  if (!found) throw std::runtime_error("the matrix method does not converge");
  return chung::y_vector(found->object_from_hand);
}

GaussNewtonResult distortion_inside(const PerspectiveState& start) {
  const auto found = gauss_newton(chung::observe({}), start);
  if (!found) throw std::runtime_error("Gauss-Newton does not converge");
  return *found;
}

void print_table2(const YVector& compensated) {
  fmt::print("Table 2: Y = object_from_hand1, Gibbs vector z and translation p [mm]\n\n");
  fmt::print("| | z1 | z2 | z3 | p1 | p2 | p3 |\n|---|---|---|---|---|---|---|\n");
  print_row("ideal, printed", chung::printed_ideal());
  print_row("ideal, ours", ideal());
  print_row("distortion ignored, printed", chung::printed_distortion_ignored());
  print_row("distortion ignored, ours", distortion_ignored({}));
  print_row("compensated, printed", chung::printed_compensated());
  print_row("compensated, ours", compensated);
}

/// How the error depends on the object that the paper does not give.
void print_objects() {
  fmt::print("\nDistortion ignored, other objects: error of z [%] and p [mm]\n\n");
  fmt::print("| object | z1 | z2 | z3 | p1 | p2 | p3 |\n|---|---|---|---|---|---|---|\n");
  const auto print_error = [](const std::string& name, const YVector& y) {
    const YVector error = y - ideal();
    const Eigen::Vector3d z = 100.0 * error.head<3>().cwiseQuotient(ideal().head<3>());
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", name, z(0), z(1),
               z(2), error(3), error(4), error(5));
  };
  print_error("the paper's, not given", chung::printed_distortion_ignored());
  print_error("225 x 233 x 300 mm, fills the image (ours)", distortion_ignored({}));
  for (const double half_mm : {60.0, 85.0, 112.0}) {
    for (const double depth_mm : {50.0, 150.0, 300.0}) {
      chung::CalibrationObject object;
      const Eigen::Vector2d middle_mm = 0.5 * (object.from_mm + object.to_mm).head<2>();
      object.from_mm << middle_mm.array() - half_mm, -depth_mm;
      object.to_mm << middle_mm.array() + half_mm, 0.0;
      print_error(fmt::format("{0:.0f} x {0:.0f} x {1:.0f} mm", 2 * half_mm, depth_mm),
                  distortion_ignored(object));
    }
  }
}

void write_figure(const std::filesystem::path& file, const std::string& title,
                  const GaussNewtonResult& result) {
  std::ofstream stream(file);
  stream << "# " << title << ": error of z and of p [mm] against the ideal\n"
         << "# iteration z1 z2 z3 p1 p2 p3\n";
  for (std::size_t i = 0; i < result.history.size(); ++i) {
    const YVector error = chung::y_vector(result.history[i].object_from_hand) - ideal();
    stream << i;
    for (int k = 0; k < 6; ++k) stream << fmt::format(" {:.9e}", error(k));
    stream << '\n';
  }
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

double relative_error(const GaussNewtonResult& result) {
  const YVector error = chung::y_vector(result.state.object_from_hand) - ideal();
  return error.cwiseQuotient(ideal()).cwiseAbs().maxCoeff();
}

struct Start {
  std::string name;
  std::string file;  ///< of its figure; empty: none
  PerspectiveState state;
};

std::vector<Start> starts() {
  std::vector<Start> all;
  PerspectiveState state = chung::truth();
  state.object_from_hand = chung::pose_of(0.75 * ideal());
  all.push_back({"Figure 4: 75 % of rotation and translation", "chung_figure4.dat", state});

  state = chung::truth();
  state.lens.k1_per_mm2 *= 0.75;
  state.lens.centre_px *= 0.75;
  all.push_back({"Figure 5: 75 % of distortion and image centre", "chung_figure5.dat", state});

  // The last element is the scale: 90 % of all would be the same matrix.
  state = chung::truth();
  for (PerspectiveMatrix& matrix : state.matrices) {
    const double last = matrix(2, 3);
    matrix *= 0.9;
    matrix(2, 3) = last;
  }
  all.push_back({"Figure 6: 90 % of the perspective matrix", "chung_figure6.dat", state});

  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      state = chung::truth();
      for (PerspectiveMatrix& matrix : state.matrices) matrix(row, column) *= 0.9;
      all.push_back(
          {fmt::format("90 % of element {}{} of each matrix", row + 1, column + 1), "", state});
    }
  }
  return all;
}

void print_convergence(const std::filesystem::path& folder) {
  fmt::print("\nGauss-Newton with the distortion inside (the paper: 5 to 6 iterations)\n\n");
  fmt::print("| start | iterations | largest relative error of Y |\n|---|---|---|\n");
  for (const Start& start : starts()) {
    const GaussNewtonResult result = distortion_inside(start.state);
    fmt::print("| {} | {} | {:.1e} |\n", start.name, result.iterations, relative_error(result));
    if (!start.file.empty()) write_figure(folder / start.file, start.name, result);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("Usage: papers_chung FOLDER   (of the figures' data)\n", stderr);
    return 1;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    print_table2(chung::y_vector(distortion_inside(starts().front().state).state.object_from_hand));
    print_objects();
    print_convergence(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "papers_chung: %s\n", error.what());
    return 2;
  }
  return 0;
}
