// Meshes of discs, annuli and wheels.
#include "tire/planar/planar_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "tests/tire/planar/planar_examples.hpp"

namespace furrow::tire {
namespace {

double area(const PlanarMesh& m, int e) {
  const auto& [a, b, c] = m.triangles[e];
  const PlanarField& p = m.position;
  return 0.5 * ((p.x[b] - p.x[a]) * (p.z[c] - p.z[a]) - (p.x[c] - p.x[a]) * (p.z[b] - p.z[a]));
}

/// Area of a regular polygon with n corners on a circle.
double polygon(double radius, int n) { return 0.5 * n * radius * radius * std::sin(2.0 * std::numbers::pi / n); }

/// Checks that triangles run through every inner edge once in each direction. @returns the other edges
std::set<std::pair<int, int>> edges_of_one_triangle(const PlanarMesh& m) {
  std::set<std::pair<int, int>> once;
  for (const auto& t : m.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      EXPECT_EQ(once.count({a, b}), 0U) << "twice in one direction";
      if (once.erase({b, a}) == 0) once.insert({a, b});
    }
  return once;
}

TEST(PlanarMesh, triangles_fill_disc_and_annulus_without_gaps_and_overlaps) {
  for (const int around : {6, 7, 24, 61})
    for (const int rings : {1, 2, 5}) {
      if (rings > planar_most_rings(0.3, 0.5, around)) continue;
      const PlanarMesh disc = planar_disc(0.3, around, 0.5), tire = planar_annulus(0.3, 0.5, rings, around);
      EXPECT_EQ(tire.elements(), 2 * rings * around);
      for (const PlanarMesh& m : {disc, tire}) {
        double sum = 0.0;
        for (int e = 0; e < m.elements(); ++e) {
          EXPECT_GT(area(m, e), 0.0) << around << " " << rings << " " << e;
          sum += area(m, e);
        }
        const bool whole = m.inner.empty();
        EXPECT_NEAR(sum, polygon(whole ? 0.3 : 0.5, around) - (whole ? 0.0 : polygon(0.3, around)), 1e-12);
        const auto edge = edges_of_one_triangle(m);
        EXPECT_EQ(edge.size(), m.outer.size() + m.inner.size());
        for (std::size_t j = 0; j < m.outer.size(); ++j)
          EXPECT_EQ(edge.count({m.outer[j], m.outer[(j + 1) % m.outer.size()]}), 1U);
        for (std::size_t j = 0; j < m.inner.size(); ++j)
          EXPECT_EQ(edge.count({m.inner[(j + 1) % m.inner.size()], m.inner[j]}), 1U);
      }
    }
}

TEST(PlanarMesh, disc_and_tire_share_the_nodes_of_the_rim) {
  for (const int rings : {1, 2, 3, 4}) {
    const PlanarMesh disc = planar_disc(0.25, 24, rings % 2 ? 0.5 : 0.0), tire = planar_annulus(0.25, 0.5, rings, 24);
    const PlanarMesh wheel = small_wheel(24, rings);
    EXPECT_EQ(wheel.nodes(), disc.nodes() + tire.nodes() - 24);
    EXPECT_EQ(wheel.elements(), disc.elements() + tire.elements());
    EXPECT_EQ(edges_of_one_triangle(wheel).size(), wheel.outer.size());
    EXPECT_EQ(wheel.rim.size(), 24U);
    for (const int n : wheel.rim) EXPECT_NEAR(std::hypot(wheel.position.x[n], wheel.position.z[n]), 0.25, 1e-12);
    std::map<int, double> filled;
    for (int e = 0; e < wheel.elements(); ++e) filled[wheel.part[e]] += area(wheel, e);
    EXPECT_NEAR(filled[0], polygon(0.25, 24), 1e-12);
    EXPECT_NEAR(filled[1], polygon(0.5, 24) - polygon(0.25, 24), 1e-12);
    EXPECT_NEAR(wheel.position.z[wheel.outer[0]], -0.5, 1e-15);  // a node at the lowest point
    EXPECT_EQ(wheel.position.x[wheel.centre], 0.0);
  }
}

TEST(PlanarMesh, rings_must_not_cut_each_other) {
  EXPECT_LT(planar_most_rings(0.3, 0.5, 6), 4);
  EXPECT_GT(planar_most_rings(0.3, 0.5, 60), 60);
}

TEST(PlanarMesh, an_annulus_is_its_own_mirror_image) {
  const PlanarMesh m = planar_annulus(0.2, 0.5, 4, 30);
  const auto place = [&](int n, double mirror) {
    return std::pair(std::lround(1e9 * mirror * m.position.x[n]), std::lround(1e9 * m.position.z[n]));
  };
  std::set<std::set<std::pair<long, long>>> given, mirrored;
  for (const auto& t : m.triangles) {
    given.insert({place(t[0], 1), place(t[1], 1), place(t[2], 1)});
    mirrored.insert({place(t[0], -1), place(t[1], -1), place(t[2], -1)});
  }
  EXPECT_EQ(given, mirrored);
}

TEST(PlanarMesh, triangles_of_a_disc_are_of_one_size) {
  const PlanarMesh disc = planar_disc(1.0, 72);
  const double mean = std::numbers::pi / disc.elements();
  for (int e = 0; e < disc.elements(); ++e) {
    EXPECT_GT(area(disc, e), 0.6 * mean);
    EXPECT_LT(area(disc, e), 1.4 * mean);
  }
}

}  // namespace
}  // namespace furrow::tire
