// A body on grains: no grain gets through its surface.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "terrain/dem/dem_terrain.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {
constexpr double kStep = 6e-5;  // H, s

dem::DemOptions small_bin(double length) {
  dem::DemOptions options;
  options.radius = 0.01;
  options.layers = 5;
  options.length = length;
  options.width = 0.24;
  options.cache = false;
  options.step = kStep;
  return options;
}

ContactMaterial steel() {
  ContactMaterial material;
  material.young_modulus = 2.49e7;
  material.poisson_ratio = 0.3;
  material.friction = 0.5;
  material.restitution = 0.2;
  material.normal_stiffness = 1e6;
  material.normal_damping = 60.0;
  return material;
}

TEST(SurfaceCoupling, no_grain_passes_through_a_plate_that_is_rammed_into_the_bed) {
  const auto terrain = make_dem_terrain(small_bin(0.4));
  terrain->prepare({});
  const testing::Surface box = testing::box({-0.06, -0.06, 0.0}, {0.06, 0.06, 0.1});
  const double bottom = terrain->gather_top_height(0.13, 0.27, -0.07, 0.07) + 1e-4;
  Vec3 position(0.2, 0.0, bottom), velocity = Vec3::Zero();
  const auto state = [&] {
    SurfaceState state;
    for (const Vec3& x : box.vertex) state.position.push_back(position + x);
    state.velocity.assign(box.vertex.size(), velocity);
    return state;
  };
  terrain->attach(box.mesh, steel(), state());
  const int steps = 600;  // 2 m/s for 36 ms would be the whole bed: stop after 30 mm
  int inside = 0;
  for (int i = 0; i < steps; ++i) {
    velocity = Vec3(0.0, 0.0, bottom - position.z() < 0.03 ? -2.0 : 0.0);
    const SurfaceState target = state();
    NodalForces forces;
    ContactSums sums;
    const Outcome status = terrain->advance({&target, 1}, kStep, 1, {&forces, 1}, {&sums, 1});
    ASSERT_TRUE(status.ok) << status.message("terrain");
    position += kStep * velocity;
  }
  TerrainFrame frame;
  terrain->gather_frame(frame);
  for (std::size_t g = 0; g < frame.radius.size(); ++g) {
    const Vec3 x(frame.position[3 * g], frame.position[3 * g + 1], frame.position[3 * g + 2]);
    const Vec3 local = x - position;
    if (std::abs(local.x()) < 0.055 && std::abs(local.y()) < 0.055 && local.z() > 0.0 && local.z() < 0.1) ++inside;
  }
  EXPECT_EQ(inside, 0);
}

}  // namespace
}  // namespace furrow::terrain
