// Grains moved over creases, warped quads and vertex fans through the whole solver, friction and history included: the
// force is continuous along the path and tends to the plane's as the angle vanishes. (The geometry alone, by bisection:
// surface_contact_test.cpp.)
//
// The undamped grain of 2000 t keeps its given velocity: its change in a step gives the force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/terrain/surface_meshes.hpp"
#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification::creases_test {
namespace {

using terrain::dem::GrainSolver;

constexpr double kRadius = 0.006;  // m
constexpr double kFriction = 0.5;  // -
constexpr double kOverlap = 1e-4;  // m, 1.7 % of the radius
const Vec3 kPlace(0.3, 0.0, 0.3);  // of the surface's origin in the bin, m

EngineGrains carried() {
  EngineGrains few;
  few.options.friction = kFriction;
  few.options.restitution = 1.0;
  few.options.density = 2.5e12;
  return few;
}

/// Forces on a grain whose centre moves along path(0 … 1) in `steps` steps, over the plane's normal force.
std::vector<Vec3> forces_along(const testing::Surface& surface, const std::function<Vec3(double)>& path, int steps) {
  const EngineGrains few = carried();
  const terrain::dem::ContactCoefficients k = few.coefficients().floor;
  const double mass = few.mass(), dt = 1e-5;
  terrain::dem::GrainSolver s = few.make({terrain::dem::quad(kPlace + path(0.0))});
  testing::Surface here = surface;
  for (Vec3& x : here.vertex) x += kPlace;
  attach(s, here, k);
  const double plane = few.floor_stiffness() * std::pow(kOverlap, 1.5);
  std::vector<Vec3> forces;
  for (int step = 0; step < steps; ++step) {
    // Towards the path and not along it, to correct errors of the last step.
    const Vec3 given = (kPlace + path((step + 1.0) / steps) - terrain::dem::position(s, 0)) / dt;
    s.grains().velocity[0] = terrain::dem::quad(given);
    s.grains().spin[0] = {};
    s.step(dt);
    forces.push_back(mass / dt * (terrain::dem::velocity(s, 0) - given) / plane);
  }
  return forces;
}

double largest_jump(const std::vector<Vec3>& forces, std::size_t from) {
  double jump = 0.0;
  for (std::size_t n = from + 1; n < forces.size(); ++n) jump = std::max(jump, (forces[n] - forces[n - 1]).norm());
  return jump;
}

/// The path on which a grain has the overlap kOverlap with the nearer flank of a crease along y, or with its ridge.
Vec3 over_crease(double half, double x) {
  const double arm = kRadius - kOverlap;
  if (half < 0.0 && std::abs(x) < arm * std::sin(-half)) return {x, 0.0013, std::sqrt(arm * arm - x * x)};
  return {x, 0.0013, arm / std::cos(half) + std::abs(x) * std::tan(half)};
}

/// Sliding up to friction takes a few µm; then the force is the plane's, turned with the flank by half the crease's
/// angle: |ΔF| = 2 sin(θ/4) √(1 + μ²). Over the middle of a valley |F_n| is 1/cos(θ/2), nowhere twice.
TEST(Creases, force_over_a_crease_is_the_planes_turned_by_half_the_angle) {
  constexpr int kSteps = 4000;
  for (const double degrees : {-20.0, -5.0, -1.0, -0.1, -0.01, 0.01, 0.1, 1.0, 5.0, 20.0}) {
    const double half = 0.5 * degrees * M_PI / 180.0;
    const auto path = [&](double share) { return over_crease(half, -2e-3 + 4e-3 * share); };
    const std::vector<Vec3> forces = forces_along(testing::crease(half), path, kSteps);
    const double turned = 2.0 * std::sin(0.5 * std::abs(half)) * std::sqrt(1.0 + kFriction * kFriction);
    double farthest = 0.0, largest = 0.0, smallest = 1e9;
    for (std::size_t n = kSteps / 4; n < forces.size(); ++n) {
      farthest = std::max(farthest, (forces[n] - Vec3(-kFriction, 0.0, 1.0)).norm());
      largest = std::max(largest, forces[n].norm());
      smallest = std::min(smallest, forces[n].norm());
    }
    const double flat = std::sqrt(1.0 + kFriction * kFriction);
    const std::string name = "crease of " + brief(degrees) + " degrees, mindlin";
    verify(name, "farthest from the plane's force, of its normal part", farthest, turned, 0.02,
           "2 sin(theta/4) sqrt(1 + mu^2)", std::max(turned, 1e-4));
    verify(name, "largest force, of the plane's", largest / flat, 1.0, 1.0 / std::cos(half) - 1.0 + 1e-3,
           "between 1 and 1/cos(theta/2)");
    verify(name, "smallest force, of the plane's", smallest / flat, 1.0, 1e-3, "1");
  }
}

/// In steps of half the length, a continuous force changes half as much; a jump does not. The last quarter of
/// friction's build-up is left out.
void expect_continuous(const std::string& name, const testing::Surface& surface,
                       const std::function<Vec3(double)>& path, Worst& worst) {
  constexpr int kSteps = 8000;
  const auto coarse = forces_along(surface, path, kSteps), fine = forces_along(surface, path, 8 * kSteps);
  const double jump = largest_jump(coarse, kSteps / 8), smaller = largest_jump(fine, kSteps);
  // The part that does not fall to an eighth: (8 small − large)/7 for a jump, 0 for a slope.
  worst.add(std::max(0.0, (8.0 * smaller - jump) / 7.0), 0.0, 1.0, name);
}

TEST(Creases, force_over_creases_warped_quads_and_fans_is_continuous) {
  const std::string source = "jump left when steps are 8 times shorter";
  {
    Worst worst("creases of -20 to 20 degrees, mindlin", "jump of the force, of the plane's", 2e-3, source);
    for (const double degrees : {-20.0, -1.0, -0.1, 0.1, 1.0, 20.0}) {
      const double half = 0.5 * degrees * M_PI / 180.0;
      // Level, so that the overlap changes too; in at most its own depth.
      const double reach = std::min(1e-3, 0.5 * kOverlap / std::abs(std::sin(half)));
      const double height = (kRadius - kOverlap) / std::cos(half);
      expect_continuous(
          brief(degrees) + " degrees", testing::crease(half),
          [=](double share) { return Vec3(reach * (2.0 * share - 1.0), 0.0013 + 2e-4 * share, height); }, worst);
    }
  }
  {
    terrain::dem::Uniform any(17);
    Worst worst("warped quads, mindlin", "jump of the force, of the plane's", 2e-3, source);
    for (const double rough : {1e-5, 5e-5}) {
      const testing::Surface warped =
          testing::sheet(-0.05, -0.05, 0.01, 10, 10, [&](double, double) { return rough * any(); });
      for (int path = 0; path < 3; ++path) {
        const Vec3 from(0.02 * any(), 0.02 * any(), kRadius - kOverlap);
        const Vec3 way(0.008 * any(), 0.008 * any(), 0.0);
        expect_continuous(
            "roughness " + brief(rough) + " m", warped, [=](double share) { return Vec3(from + share * way); }, worst);
      }
    }
  }
  {
    Worst worst("vertex fans, mindlin", "jump of the force, of the plane's", 2e-3, source);
    for (const int count : {4, 8})
      for (const double slope : {-0.1, 0.01, 0.1})
        for (const double aside : {0.0, 1.1e-4}) {
          const testing::Surface around = testing::fan(count, 0.03, [=](int) { return 0.03 * slope; });
          const double height = (kRadius - kOverlap) * (slope > 0.0 ? std::sqrt(1.0 + slope * slope) : 1.0);
          const double reach = std::min(1e-3, 0.5 * kOverlap / std::abs(slope));
          expect_continuous(
              std::to_string(count) + " triangles, slope " + brief(slope), around,
              [=](double share) { return Vec3(reach * (2.0 * share - 1.0), aside + 0.1 * reach * share, height); },
              worst);
        }
  }
}

/// As the roughness of a warped sheet vanishes, the force tends to the plane's in proportion.
TEST(Creases, force_over_warped_quads_tends_to_the_planes) {
  Worst worst("warped quads, mindlin", "force off the plane's, by 3/2 roughness/overlap", 1.5,
              "linear in the roughness");
  for (const double rough : {1e-8, 1e-7, 1e-6}) {
    terrain::dem::Uniform any(23);
    const testing::Surface warped =
        testing::sheet(-0.05, -0.05, 0.01, 10, 10, [&](double, double) { return rough * any(); });
    const auto forces = forces_along(
        warped, [](double share) { return Vec3(-0.02 + 0.04 * share, 0.0137 * share, kRadius - kOverlap); }, 4000);
    double off = 0.0;
    for (std::size_t n = 1000; n < forces.size(); ++n) {
      const Vec3 way = Vec3(0.04, 0.0137, 0.0).normalized();
      off = std::max(off, (forces[n] - (Vec3::UnitZ() - kFriction * way)).norm());
    }
    worst.add(off / (1.5 * rough / kOverlap), 0.0, 1.0, brief(rough) + " m");
  }
}

}  // namespace
}  // namespace furrow::verification::creases_test
