// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/vector_quantisation.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "daemon/handeye/pairing.hpp"

namespace handeye {
namespace {

std::vector<Eigen::Vector3d> normal_vectors(std::size_t count) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> vectors(count);
  for (Eigen::Vector3d& v : vectors) v = v.unaryExpr([&](double) { return normal(generator); });
  return vectors;
}

double distortion(const std::vector<Eigen::Vector3d>& vectors, const std::vector<Cell>& cells) {
  double sum = 0;
  for (const Cell& cell : cells) {
    for (const std::size_t k : cell.members) sum += (vectors[k] - cell.centre).squaredNorm();
  }
  return sum / static_cast<double>(vectors.size());
}

TEST(VectorQuantisation, PutsEveryVectorIntoOneCell) {
  const auto vectors = normal_vectors(1000);
  const auto cells = quantise(vectors, 37);
  EXPECT_EQ(cells.size(), 37U);
  std::vector<int> seen(vectors.size(), 0);
  for (const Cell& cell : cells) {
    EXPECT_FALSE(cell.members.empty());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::size_t k : cell.members) {
      ++seen[k];
      mean += vectors[k] / static_cast<double>(cell.members.size());
    }
    EXPECT_TRUE(mean.isApprox(cell.centre, 1e-9));
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 1000);
}

/// A good quantiser's distortion falls with the number of cells to the power -2/3: by 4 from 8 to
/// 64 cells; one that splits down a tree does nearly as well.
TEST(VectorQuantisation, DistortsLessWithMoreCells) {
  const auto vectors = normal_vectors(4000);
  const double one = distortion(vectors, quantise(vectors, 1));
  const double eight = distortion(vectors, quantise(vectors, 8));
  const double many = distortion(vectors, quantise(vectors, 64));
  EXPECT_NEAR(one, 3.0, 0.15);
  EXPECT_LT(eight, 0.45 * one);
  EXPECT_LT(many, 0.35 * eight);
}

TEST(VectorQuantisation, SeparatesWhatIsSeparate) {
  std::vector<Eigen::Vector3d> vectors;
  for (int k = 0; k < 60; ++k) {
    vectors.push_back(Eigen::Vector3d::Unit(k % 3) + 1e-3 * Eigen::Vector3d(k, -k, 0) / 60);
  }
  for (const Cell& cell : quantise(vectors, 3)) {
    EXPECT_EQ(cell.members.size(), 20U);
    for (const std::size_t k : cell.members) EXPECT_EQ(k % 3, cell.members.front() % 3);
  }
}

TEST(VectorQuantisation, KeepsEqualVectorsTogether) {
  const std::vector<Eigen::Vector3d> same(10, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(quantise(same, 5).size(), 1U);
  EXPECT_TRUE(quantise({}, 5).empty());
  EXPECT_TRUE(quantise(same, 0).empty());
}

TEST(SpreadPairs, AreAllPairsOfAFew) {
  for (std::size_t n = 0; n < 12; ++n) {
    const auto pairs = spread_pairs(n, 20);
    const std::set<std::array<std::size_t, 2>> distinct(pairs.begin(), pairs.end());
    EXPECT_EQ(distinct.size(), n < 2 ? 0 : n * (n - 1) / 2);
    EXPECT_EQ(pairs.size(), distinct.size());
  }
}

TEST(SpreadPairs, AreBoundedEvenAndDistinct) {
  for (const std::size_t n : {50U, 199U, 200U, 1000U}) {
    const auto pairs = spread_pairs(n, 20);
    const std::set<std::array<std::size_t, 2>> distinct(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs.size(), distinct.size());
    std::vector<std::size_t> partners(n, 0);
    for (const auto& [i, j] : pairs) {
      ASSERT_LT(i, j);
      ASSERT_LT(j, n);
      ++partners[i];
      ++partners[j];
    }
    EXPECT_EQ(*std::min_element(partners.begin(), partners.end()),
              *std::max_element(partners.begin(), partners.end()));
    EXPECT_LE(partners.front(), 20U);
    EXPECT_GE(partners.front(), 18U);
  }
}

}  // namespace
}  // namespace handeye
