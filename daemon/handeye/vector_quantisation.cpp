// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/vector_quantisation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

namespace handeye {
namespace {

constexpr int kSettlingRounds = 4;
constexpr double kMinSpread = 1e-9;  // of the vectors' length: below it they are the same

struct Node {
  Cell cell;
  Eigen::Matrix3d scatter{Eigen::Matrix3d::Zero()};  ///< of the members about the centre
  double distortion{0};
};

Node node_of(std::span<const Eigen::Vector3d> vectors, std::vector<std::size_t> members) {
  Node node;
  for (const std::size_t k : members) node.cell.centre += vectors[k];
  node.cell.centre /= static_cast<double>(members.size());
  double squares = 0;
  for (const std::size_t k : members) {
    const Eigen::Vector3d d = vectors[k] - node.cell.centre;
    node.scatter += d * d.transpose();
    squares += vectors[k].squaredNorm();
  }
  node.distortion = node.scatter.trace();
  if (node.distortion <= kMinSpread * kMinSpread * squares) node.distortion = 0;
  node.cell.members = std::move(members);
  return node;
}

/// Both halves have members as long as the distortion is not zero.
std::array<Node, 2> split(std::span<const Eigen::Vector3d> vectors, const Node& node) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(node.scatter);
  const Eigen::Vector3d widest = eigen.eigenvectors().col(2);
  Eigen::Vector3d middle = node.cell.centre;
  Eigen::Vector3d across = widest;
  std::array<std::vector<std::size_t>, 2> halves;
  for (int round = 0; round < kSettlingRounds; ++round) {
    std::array<std::vector<std::size_t>, 2> now;
    std::array<Eigen::Vector3d, 2> sums{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (const std::size_t k : node.cell.members) {
      const std::size_t side = across.dot(vectors[k] - middle) > 0 ? 1 : 0;
      now[side].push_back(k);
      sums[side] += vectors[k];
    }
    if (now[0].empty() || now[1].empty()) break;
    halves = std::move(now);
    const Eigen::Vector3d a = sums[0] / static_cast<double>(halves[0].size());
    const Eigen::Vector3d b = sums[1] / static_cast<double>(halves[1].size());
    middle = 0.5 * (a + b);
    across = b - a;
  }
  if (halves[0].empty()) {  // rounding hid the widest direction
    const auto half = static_cast<std::ptrdiff_t>(node.cell.members.size() / 2);
    halves[0].assign(node.cell.members.begin(), node.cell.members.begin() + half);
    halves[1].assign(node.cell.members.begin() + half, node.cell.members.end());
  }
  return {node_of(vectors, std::move(halves[0])), node_of(vectors, std::move(halves[1]))};
}

}  // namespace

std::vector<Cell> quantise(std::span<const Eigen::Vector3d> vectors, std::size_t cells) {
  if (vectors.empty() || cells == 0) return {};
  std::vector<std::size_t> everything(vectors.size());
  std::iota(everything.begin(), everything.end(), std::size_t{0});
  const auto less = [](const Node& a, const Node& b) { return a.distortion < b.distortion; };
  std::vector<Node> heap{node_of(vectors, std::move(everything))};
  while (heap.size() < cells && heap.front().distortion > 0) {
    std::pop_heap(heap.begin(), heap.end(), less);
    auto [a, b] = split(vectors, heap.back());
    heap.back() = std::move(a);
    std::push_heap(heap.begin(), heap.end(), less);
    heap.push_back(std::move(b));
    std::push_heap(heap.begin(), heap.end(), less);
  }
  std::vector<Cell> result;
  result.reserve(heap.size());
  for (Node& node : heap) result.push_back(std::move(node.cell));
  return result;
}

}  // namespace handeye
