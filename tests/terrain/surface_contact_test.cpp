// Sphere against surface: one contact on flat cuts, two in corners, continuous in between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "protocol/core/error.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

using testing::box;
using testing::crease;
using testing::fan;
using testing::hertz_force;
using testing::sheet;
using testing::Surface;

constexpr double kRadius = 6e-3;  // m
constexpr double kDegree = M_PI / 180.0;

/// Bisection separates jumps from slopes: a jump keeps its size. The sampling intervals with the largest change of
/// force are halved to a millionth of their length, always keeping the half with more change.
void expect_continuous(const SurfaceCollider& surface, const Vec3& from, const Vec3& to, double overlap,
                       const std::string& what) {
  constexpr int kSamples = 1000, kSuspects = 4;
  const double scale = std::pow(overlap, 1.5);
  auto force = [&](double share) {
    return Vec3(testing::hertz_force(surface, from + (to - from) * share, kRadius) / scale);
  };
  std::vector<std::pair<double, int>> change;
  Vec3 before = force(0.0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 after = force((i + 1.0) / kSamples);
    change.emplace_back((after - before).norm(), i);
    before = after;
  }
  std::sort(change.rbegin(), change.rend());
  for (int suspect = 0; suspect < kSuspects; ++suspect) {
    double lo = static_cast<double>(change[suspect].second) / kSamples, hi = lo + 1.0 / kSamples;
    Vec3 f_lo = force(lo), f_hi = force(hi);
    for (int halving = 0; halving < 20; ++halving) {
      const double middle = 0.5 * (lo + hi);
      const Vec3 f_middle = force(middle);
      const bool left = (f_middle - f_lo).norm() > (f_hi - f_middle).norm();
      (left ? hi : lo) = middle;
      (left ? f_hi : f_lo) = f_middle;
    }
    EXPECT_LT((f_hi - f_lo).norm(), 5e-6)
        << what << ": the force jumps by this share of the plane's at " << (from + (to - from) * lo).transpose();
  }
}

TEST(SurfaceContact, slides_over_a_cut_plane_as_over_a_plane) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.02, 0.02);
  testing::Surface flat = testing::sheet(-0.05, -0.05, 0.01, 10, 10, [](double, double) { return 0.0; });
  const SurfaceCollider surface = flat.collider(kRadius);
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  for (double share : {0.002, 0.02, 0.2, 0.6}) {
    const double overlap = share * kRadius;
    auto check = [&](double x, double y) {
      ASSERT_EQ(surface.hits({x, y, kRadius - overlap}, kRadius, hit), 1) << x << ' ' << y;
      ASSERT_NEAR(hit[0].overlap / overlap, 1.0, 1e-12);
      ASSERT_NEAR(hit[0].share, 1.0, 1e-12);
      ASSERT_LT((hit[0].normal - Vec3::UnitZ()).norm(), 1e-12);
      ASSERT_LT((hit[0].point - Vec3(x, y, 0.0)).norm(), 1e-15);
    };
    for (int i = 0; i < 2000; ++i) check(place(random), place(random));
    for (int i = 0; i < 200; ++i) check(0.01 * (i % 3), place(random));  // on edges
    for (int i = -2; i <= 2; ++i) check(0.01 * i, 0.01 * (i % 2));       // on vertices
  }
}

TEST(SurfaceContact, slides_over_a_tilted_cut_plane_far_from_the_origin_as_over_a_plane) {
  testing::Surface flat = testing::sheet(-0.05, -0.05, 0.01, 10, 10, [](double, double) { return 0.0; });
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(0.3, -0.8, 0.5).normalized()));
  const Vec3 shift(9.0, 0.3, 0.4);
  for (Vec3& x : flat.vertex) x = turn * x + shift;
  const SurfaceCollider surface = flat.collider(kRadius);
  const double overlap = 0.01 * kRadius;
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  double ripple = 0.0;
  for (int i = 0; i <= 5000; ++i) {
    const Vec3 centre = turn * Vec3(-0.02 + 8e-6 * i, 0.0017 + 1e-6 * i, kRadius - overlap) + shift;
    ASSERT_EQ(surface.hits(centre, kRadius, hit), 1);
    ripple =
        std::max({ripple, std::abs(hit[0].overlap / overlap - 1.0), (hit[0].normal - turn * Vec3::UnitZ()).norm()});
  }
  EXPECT_LT(ripple, 1e-9);
}

TEST(SurfaceContact, is_one_on_flat_fans_of_any_count) {
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  for (int count : {3, 4, 5, 6, 8, 12, 24, 40}) {
    const testing::Surface flat = testing::fan(count, 0.03, [](int) { return 0.0; });
    const SurfaceCollider surface = flat.collider(kRadius);
    for (double phi = 0.0; phi < 6.3; phi += 0.03)
      for (double rho : {0.0, 1e-9, 1e-5, 1e-3, 3e-3}) {
        const Vec3 centre(rho * std::cos(phi), rho * std::sin(phi), 0.97 * kRadius);
        ASSERT_EQ(surface.hits(centre, kRadius, hit), 1) << count << ' ' << phi << ' ' << rho;
        ASSERT_NEAR(hit[0].overlap / (0.03 * kRadius), 1.0, 1e-12);
        ASSERT_LT((hit[0].normal - Vec3::UnitZ()).norm(),
                  1e-7);  // points 1e-8 r apart are equally near in doubles
      }
  }
}

TEST(SurfaceContact, changes_without_a_jump_across_creases_and_tends_to_the_plane) {
  for (double degrees : {-20.0, -5.0, -1.0, -0.1, -0.01, 1e-5, 1e-3, 0.01, 0.1, 1.0, 5.0, 20.0})
    for (double share : {0.005, 0.05, 0.2}) {
      const double half = 0.5 * degrees * kDegree, overlap = share * kRadius;  // crease angle = 2 × slope
      const testing::Surface bent = testing::crease(half);
      const SurfaceCollider surface = bent.collider(kRadius);
      const double height = (kRadius - overlap) / std::cos(half);
      const Vec3 from(-4e-3, 1.3e-3, height), to(4e-3, 2.1e-3, height);
      const std::string what = std::to_string(degrees) + " degrees, overlap " + std::to_string(share) + " r";
      expect_continuous(surface, from, to, overlap, what);
      if (std::abs(degrees) < 6.0) {
        // A level path over a slope changes depth; right above the crease the plane's law holds.
        const double above =
            testing::hertz_force(surface, {0.0, 1.7e-3, height}, kRadius).norm() / std::pow(overlap, 1.5);
        const double ridge = std::pow((kRadius - height) / overlap, 1.5);
        EXPECT_NEAR(above, degrees > 0.0 ? 1.0 / std::cos(half) : ridge, 1e-6) << what;
      }
    }
}

TEST(SurfaceContact, counts_both_walls_of_a_right_angle) {
  const double overlap = 0.03 * kRadius;
  const SurfaceCollider surface = testing::crease(45.0 * kDegree).collider(kRadius);
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  const double height = (kRadius - overlap) * std::sqrt(2.0);
  ASSERT_EQ(surface.hits({0.0, 1e-3, height}, kRadius, hit), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(hit[i].share, 1.0, 1e-9);
    EXPECT_NEAR(hit[i].overlap / overlap, 1.0, 1e-9);
    EXPECT_NEAR(std::abs(hit[i].normal.x()), std::sqrt(0.5), 1e-12);
  }
  expect_continuous(surface, {-3e-3, 1e-3, height + 2.9e-3}, {3e-3, 1e-3, height + 2.9e-3}, overlap, "right angle");
}

TEST(SurfaceContact, changes_without_a_jump_over_warped_quads_and_fans) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const double overlap = 0.05 * kRadius;
  for (double rough : {1e-6, 1e-5, 1e-4, 5e-4}) {  // vertex offsets over 10 mm cells: 0.006 … 5 degrees
    testing::Surface warped =
        testing::sheet(-0.05, -0.05, 0.01, 10, 10, [&](double, double) { return rough * any(random); });
    const SurfaceCollider surface = warped.collider(kRadius);
    for (int path = 0; path < 12; ++path) {
      const Vec3 from(0.02 * any(random), 0.02 * any(random), kRadius - overlap);
      const Vec3 to(from.x() + 0.01 * any(random), from.y() + 0.01 * any(random), kRadius - overlap);
      expect_continuous(surface, from, to, overlap, "warped by " + std::to_string(rough));
    }
  }
  for (int count : {4, 5, 6, 8})
    for (double slope : {-0.3, -0.01, 1e-4, 0.01, 0.1, 0.3})
      for (int kind = 0; kind < 2; ++kind) {  // cones, and saddles
        const testing::Surface around =
            testing::fan(count, 0.03, [&](int k) { return 0.03 * slope * (kind == 0 ? 1.0 : (k % 2 ? 1.0 : -1.0)); });
        const SurfaceCollider surface = around.collider(kRadius);
        const double height = (kRadius - overlap) * std::sqrt(1.0 + (kind == 0 && slope > 0 ? slope * slope : 0.0));
        for (double y : {0.0, 1e-5, 1.1e-4, 1.2e-3})
          expect_continuous(surface, {-3e-3, y, height}, {3.1e-3, -0.4 * y, height}, overlap,
                            "fan of " + std::to_string(count) + ", slope " + std::to_string(slope) +
                                (kind ? " saddle" : " cone") + ", y " + std::to_string(y));
      }
}

TEST(SurfaceContact, meets_a_convex_edge_and_corner_at_the_nearest_point) {
  const SurfaceCollider surface = testing::box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}).collider(kRadius);
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  const double depth = 1e-4;
  const Vec3 edge = Vec3(1.0, 0.0, 2.0).normalized();
  ASSERT_EQ(surface.hits(Vec3(0.1, 0.01, 0.1) + (kRadius - depth) * edge, kRadius, hit), 1);
  EXPECT_NEAR(hit[0].overlap, depth, 1e-14);
  EXPECT_LT((hit[0].normal - edge).norm(), 1e-12);
  const Vec3 corner = Vec3(1.0, 3.0, 2.0).normalized();
  ASSERT_EQ(surface.hits(Vec3(0.1, 0.1, 0.1) + (kRadius - depth) * corner, kRadius, hit), 1);
  EXPECT_NEAR(hit[0].overlap, depth, 1e-14);
  EXPECT_LT((hit[0].normal - corner).norm(), 1e-12);
  EXPECT_EQ(surface.hits(Vec3(0.1, 0.1, 0.1) + 1.0001 * kRadius * corner, kRadius, hit), 0);
}

TEST(SurfaceContact, pushes_a_centre_behind_the_surface_outward) {
  const SurfaceCollider surface = testing::box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}).collider(kRadius);
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  double before = 0.0;
  for (double height = 0.5 * kRadius; height > -0.99 * kRadius; height -= 0.01 * kRadius) {
    ASSERT_EQ(surface.hits({0.0131, 0.027, 0.1 + height}, kRadius, hit), 1);
    ASSERT_NEAR(hit[0].overlap, kRadius - height, 1e-14);
    ASSERT_LT((hit[0].normal - Vec3::UnitZ()).norm(), 1e-12);
    ASSERT_GT(hit[0].overlap, before);
    before = hit[0].overlap;
  }
  EXPECT_EQ(surface.hits({0.0131, 0.027, 0.1 - 1.01 * kRadius}, kRadius, hit), 0);
  // Straight through the diagonal of the cut and through a vertex of a flat fan.
  const SurfaceCollider flat = testing::fan(6, 0.03, [](int) { return 0.0; }).collider(kRadius);
  for (double height : {1e-3, 1e-6, 0.0, -1e-6, -1e-3, -5e-3}) {
    ASSERT_EQ(flat.hits({0.0, 0.0, height}, kRadius, hit), 1) << height;
    EXPECT_NEAR(hit[0].overlap, kRadius - height, 1e-14);
    EXPECT_LT((hit[0].normal - Vec3::UnitZ()).norm(), 1e-12) << height;
  }
  // Behind a crease of either sign the push still has an outward part.
  for (double degrees : {-40.0, -5.0, 5.0, 40.0}) {
    const SurfaceCollider bent = testing::crease(degrees * kDegree).collider(kRadius);
    for (double x = -4e-3; x <= 4e-3; x += 1.1e-4) {
      const double ground = std::abs(x) * std::tan(degrees * kDegree);
      ASSERT_EQ(bent.hits({x, 1e-3, ground - 1e-3}, kRadius, hit), 1);
      ASSERT_GT(hit[0].normal.z(), 0.5);
      ASSERT_GT(hit[0].overlap, kRadius);
    }
  }
}

TEST(SurfaceContact, catches_a_vertex_that_falls_fast) {
  // A downward spike falls at 12 m/s on a resting grain in steps of 1e-4 s: 1.2 mm each, a fifth of the radius.
  testing::Surface spike = testing::fan(8, 0.02, [](int) { return 0.02; });
  for (auto& t : spike.mesh.triangles) std::swap(t[1], t[2]);  // outside down
  std::vector<Vec3> start = spike.vertex, end = spike.vertex;
  for (Vec3& x : start) x.z() += 0.012;
  for (Vec3& x : end) x.z() += 0.012 - 12.0 * 20e-4;
  SurfaceCollider surface(spike.mesh, kRadius);
  surface.set_motion(start, end, 20e-4);
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  int touched = 0;
  for (int i = 0; i <= 20; ++i) {
    surface.move_to(i / 20.0);
    const double tip = 0.012 - 1.2e-3 * i;
    const Vec3 centre(1e-4, 2e-4, 0.0);
    const int count = surface.hits(centre, kRadius, hit);
    if (tip > kRadius || tip < -0.9 * kRadius) continue;
    ASSERT_GE(count, 1) << "tip at " << tip;
    ASSERT_LT(hit[0].normal.z(), 0.0) << "tip at " << tip;
    EXPECT_LT((surface.velocity_at(hit[0]) - Vec3(0.0, 0.0, -12.0)).norm(), 1e-9);
    ++touched;
  }
  EXPECT_GE(touched, 9);
}

TEST(SurfaceContact, does_not_depend_on_when_the_grid_was_built) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  testing::Surface start = testing::wheel(0.1, 0.06, 24, 3);
  std::vector<Vec3> end = start.vertex;
  const Quat turn(Eigen::AngleAxisd(0.1, Vec3::UnitY()));
  for (Vec3& x : end) x = turn * x + Vec3(0.01, 0.0, -0.002);
  SurfaceCollider moved(start.mesh, kRadius);
  moved.set_motion(start.vertex, end, 1e-2);
  for (int step = 1; step <= 10; ++step) {
    moved.move_to(step / 10.0);
    std::vector<Vec3> now(moved.positions().begin(), moved.positions().end());
    SurfaceCollider fresh(start.mesh, kRadius);
    fresh.set_motion(now, now, 1.0);
    std::array<SurfaceHit, kMaxSurfaceHits> a, b;
    int touching = 0;
    for (int i = 0; i < 500; ++i) {
      const double phi = M_PI * any(random), rho = 0.1 + 1.2 * kRadius * any(random);
      const Vec3 centre(rho * std::sin(phi), 0.035 * any(random), -rho * std::cos(phi));
      const int na = moved.hits(centre, kRadius, a), nb = fresh.hits(centre, kRadius, b);
      ASSERT_EQ(na, nb);
      touching += na > 0;
      for (int k = 0; k < na; ++k) {
        ASSERT_EQ(a[k].triangle, b[k].triangle);
        ASSERT_EQ(a[k].overlap, b[k].overlap);
        ASSERT_EQ(a[k].share, b[k].share);
        ASSERT_EQ(a[k].point, b[k].point);
      }
    }
    EXPECT_GT(touching, 50);
  }
  EXPECT_LT(moved.grid_rebuilds(), 9);
}

TEST(SurfaceContact, finds_what_a_search_through_all_triangles_finds) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const testing::Surface round = testing::wheel(0.1, 0.06, 36, 4);
  const SurfaceCollider surface = round.collider(kRadius);
  std::array<SurfaceHit, kMaxSurfaceHits> hit;
  for (int i = 0; i < 3000; ++i) {
    const double phi = M_PI * any(random), rho = 0.1 + 2.0 * kRadius * (0.5 + 0.5 * any(random));
    const Vec3 centre(rho * std::sin(phi), 0.04 * any(random), -rho * std::cos(phi));
    double nearest = 1e9;
    for (const auto& t : round.mesh.triangles) {
      // Sampled distances bound the true one from above; facets are at most 18 mm wide.
      const int n = 12;
      for (int p = 0; p <= n; ++p)
        for (int q = 0; p + q <= n; ++q)
          nearest =
              std::min(nearest, (centre - (round.vertex[t[0]] + (round.vertex[t[1]] - round.vertex[t[0]]) * p / n +
                                           (round.vertex[t[2]] - round.vertex[t[0]]) * q / n))
                                    .norm());
      if (nearest < 0.9 * kRadius) break;
    }
    const int count = surface.hits(centre, kRadius, hit);
    if (nearest < kRadius) {
      ASSERT_GE(count, 1) << centre.transpose();
    } else if (nearest > kRadius + 2e-3) {
      ASSERT_EQ(count, 0) << centre.transpose();
    }
  }
}

TEST(SurfaceContact, inside_a_box_is_the_same_when_restricted_to_it) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const testing::Surface round = testing::wheel(0.1, 0.06, 36, 4);
  const SurfaceCollider all = round.collider(kRadius);
  SurfaceCollider part(round.mesh, kRadius);
  std::array<SurfaceHit, kMaxSurfaceHits> a, b;
  std::vector<Vec3> end = round.vertex;
  for (int step = 0; step < 50; ++step) {
    // The bed's top drifts a little, as in a run. This must not make a new grid each time.
    part.restrict_to({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, -0.08 + 1e-4 * std::sin(step))});
    part.set_motion(round.vertex, end, 1.0);
    for (int i = 0; i < 100; ++i) {
      const double phi = 0.5 * any(random), rho = 0.1 + kRadius * any(random);
      const Vec3 centre(rho * std::sin(phi), 0.035 * any(random), -rho * std::cos(phi));
      if (centre.z() > -0.0801) continue;
      const int count = all.hits(centre, kRadius, a);
      ASSERT_EQ(part.hits(centre, kRadius, b), count);
      for (int k = 0; k < count; ++k) ASSERT_EQ(a[k].overlap, b[k].overlap);
    }
  }
  EXPECT_LE(part.grid_rebuilds(), 2);
  EXPECT_EQ(part.hits({0.0, 0.0, 0.1 + 0.5 * kRadius}, kRadius, b), 0);
}

TEST(SurfaceContact, refuses_a_mesh_that_names_a_missing_vertex) {
  SurfaceMesh mesh;
  mesh.vertex_count = 3;
  mesh.triangles = {{0, 1, 3}};
  EXPECT_THROW(SurfaceCollider(mesh, kRadius), Error);
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(SurfaceCollider(mesh, 0.0), Error);
}

}  // namespace
}  // namespace furrow::terrain
