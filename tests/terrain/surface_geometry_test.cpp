// Closest points of a triangle against brute force and by region; the push-out problem against its own conditions;
// angles against atan2.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "terrain/surface/facets.hpp"
#include "terrain/surface/surface_vectors.hpp"

namespace furrow::terrain {
namespace {

const Vec3 kA(0.0, 0.0, 0.0), kB(1.0, 0.0, 0.0), kC(0.0, 1.0, 0.0);

TrianglePoint closest(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return closest_point(triple(p), triple(a), triple(b), triple(c));
}
std::vector<Vector> triples(const std::vector<Vec3>& of) {
  std::vector<Vector> out;
  for (const Vec3& v : of) out.push_back(triple(v));
  return out;
}
int solve_push_out(const std::vector<Vec3>& normal, const std::vector<double>& overlap, std::span<double> lambda) {
  return push_out(triples(normal).data(), overlap.data(), static_cast<int>(normal.size()), lambda.data());
}

TEST(ClosestPoint, names_each_of_the_seven_regions) {
  struct Case {
    Vec3 from, expected;
    TriangleRegion region;
  };
  const Case cases[] = {
      {{0.2, 0.3, 0.5}, {0.2, 0.3, 0.0}, TriangleRegion::face},
      {{0.4, -0.3, 0.5}, {0.4, 0.0, 0.0}, TriangleRegion::edge_0},
      {{0.9, 0.7, -0.5}, {0.6, 0.4, 0.0}, TriangleRegion::edge_1},
      {{-0.4, 0.3, 0.1}, {0.0, 0.3, 0.0}, TriangleRegion::edge_2},
      {{-0.4, -0.3, 0.1}, kA, TriangleRegion::vertex_0},
      {{1.7, 0.1, 0.1}, kB, TriangleRegion::vertex_1},
      {{-0.1, 1.4, 0.1}, kC, TriangleRegion::vertex_2},
  };
  for (const Case& one : cases) {
    const TrianglePoint found = closest(one.from, kA, kB, kC);
    EXPECT_EQ(found.region, one.region) << one.from.transpose();
    EXPECT_LT((vec(found.point) - one.expected).norm(), 1e-15) << vec(found.point).transpose();
    const Vec3 rebuilt = found.weight[0] * kA + found.weight[1] * kB + found.weight[2] * kC;
    EXPECT_LT((rebuilt - vec(found.point)).norm(), 1e-15);
  }
}

TEST(ClosestPoint, is_nearer_than_every_point_of_a_fine_sampling) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  auto point = [&] { return Vec3(any(random), any(random), any(random)); };
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 a = point(), b = point(), c = point(), p = 2.0 * point();
    const TrianglePoint found = closest(p, a, b, c);
    const double distance = (p - vec(found.point)).norm();
    double sampled = 1e9;
    const int n = 40;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        sampled = std::min(sampled, (p - (a + (b - a) * i / n + (c - a) * j / n)).norm());
    ASSERT_LE(distance, sampled + 1e-14);
    ASSERT_GE(distance, sampled - 3.0 / n);
    double sum = 0.0;
    for (double w : found.weight) {
      ASSERT_GE(w, -1e-15);
      sum += w;
    }
    ASSERT_NEAR(sum, 1.0, 1e-15);
  }
}

TEST(PushOut, of_one_wall_is_its_overlap) {
  const std::vector<Vec3> normal{Vec3::UnitZ()};
  const std::vector<double> overlap{2e-4};
  double lambda[1];
  EXPECT_EQ(solve_push_out(normal, overlap, lambda), 1);
  EXPECT_NEAR(lambda[0] / overlap[0], 1.0, 1e-12);
}

TEST(PushOut, of_two_equal_walls_shares_by_one_over_one_plus_cosine) {
  for (double degrees : {0.01, 0.1, 1.0, 5.0, 20.0, 45.0, 90.0}) {
    const double theta = degrees * M_PI / 180.0;
    const std::vector<Vec3> normal{{-std::sin(theta / 2), 0.0, std::cos(theta / 2)},
                                   {std::sin(theta / 2), 0.0, std::cos(theta / 2)}};
    const std::vector<double> overlap{1e-4, 1e-4};
    double lambda[2];
    EXPECT_EQ(solve_push_out(normal, overlap, lambda), 2);
    for (double one : lambda) EXPECT_NEAR(one / 1e-4, 1.0 / (1.0 + std::cos(theta)), 1e-3) << degrees;
  }
}

TEST(PushOut, of_walls_that_face_each_other_counts_both_fully) {
  const std::vector<Vec3> normal{Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitZ()};
  const std::vector<double> overlap{1e-4, 2e-4, 3e-4};
  double lambda[3];
  EXPECT_EQ(solve_push_out(normal, overlap, lambda), 3);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(lambda[i], overlap[i], 1e-15);
}

TEST(PushOut, meets_the_complementarity_conditions_for_random_walls) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0), depth(0.1, 1.0);
  int checked = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double spread = std::pow(10.0, 1.5 * any(random) - 1.0);  // from nearly parallel to wide
    const int count = 2 + trial % 5;
    std::vector<Vec3> normal(count);
    std::vector<double> overlap(count), lambda(count);
    for (int i = 0; i < count; ++i) {
      normal[i] = Vec3(spread * any(random), spread * any(random), 1.0).normalized();
      overlap[i] = 1.0 + 0.2 * spread * spread * any(random);
      if (overlap[i] <= 0.0) overlap[i] = depth(random);
    }
    solve_push_out(normal, overlap, lambda);
    double least_cosine = 1.0;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) least_cosine = std::min(least_cosine, normal[i].dot(normal[j]));
    for (int i = 0; i < count; ++i) {
      ASSERT_GE(lambda[i], 0.0);
      ASSERT_LE(lambda[i], overlap[i]);
      if (least_cosine < 0.0) continue;
      ++checked;
      double w = -overlap[i];
      for (int j = 0; j < count; ++j) w += lambda[j] * normal[i].dot(normal[j]);
      ASSERT_GE(w, -1e-9) << "trial " << trial << ": wall " << i << " is not cleared";
      ASSERT_LE(lambda[i] * w, 1e-8) << "trial " << trial;
    }
  }
  EXPECT_GT(checked, 2000);
}

TEST(PushOut, shares_the_depth_of_walls_of_one_direction_only) {
  const std::vector<Vec3> normal{Vec3::UnitZ(), Vec3(0.1, 0.0, 1.0).normalized(), Vec3::UnitX()};
  const std::vector<double> overlap{3e-4, 1e-4, 2e-4};
  double shared[3];
  share_depth(triples(normal).data(), overlap.data(), 3, shared);
  EXPECT_EQ(shared[0], 3e-4);
  EXPECT_NEAR(shared[1], 3e-4, 1e-18);
  EXPECT_EQ(shared[2], 2e-4);
}

TEST(Facets, angle_is_that_of_atan2) {
  for (int k = 1; k < 4000; ++k) {
    const double phi = M_PI * k / 4000.0, scale = std::pow(10.0, k % 13 - 6.0);
    EXPECT_NEAR(angle_of(scale * std::sin(phi), scale * std::cos(phi)), phi, 2e-11) << phi;
  }
}

}  // namespace
}  // namespace furrow::terrain
