// Bodies on grains: weight, impulses, several at once, no grain through a surface. Every body is stepped as a partner
// of the co-simulation: the force of an interval acts on it during the next.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "protocol/core/constants.hpp"
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

/// A block guided vertically, with a damper to the world while it finds its rest.
struct Block {
  testing::Surface surface = testing::box({-0.06, -0.06, 0.0}, {0.06, 0.06, 0.1});
  double mass = 20.0;            // kg
  double damper = 0.0;           // N s/m
  Vec3 position = Vec3::Zero();  // m
  Vec3 velocity = Vec3::Zero();  // m/s
  Vec3 force = Vec3::Zero();     // by the grains, N
  Vec3 impulse = Vec3::Zero();   // received, N s

  SurfaceState state() const {
    SurfaceState state;
    for (const Vec3& x : surface.vertex) state.position.push_back(position + x);
    state.velocity.assign(surface.vertex.size(), velocity);
    return state;
  }
  void advance(const NodalForces& next) {
    velocity.z() += kStep * ((force.z() - damper * velocity.z()) / mass - kStandardGravity);
    position.z() += kStep * velocity.z();
    force = Vec3::Zero();
    for (const Vec3& f : next.force) force += f;
    impulse += kStep * force;
  }
};

struct Scene {
  std::unique_ptr<Terrain> terrain;
  std::vector<Block> blocks;
  std::vector<NodalForces> forces;
  std::vector<ContactSums> sums;
  double worst_force_residual = 0.0, worst_moment_residual = 0.0;

  explicit Scene(const dem::DemOptions& options) : terrain(make_dem_terrain(options)) { terrain->prepare({}); }

  void put(double x, double mass) {
    Block block;
    block.mass = mass;
    block.damper = 50.0 * mass;  // falls at 0.2 m/s
    block.position = Vec3(x, 0.0, terrain->gather_top_height(x - 0.07, x + 0.07, -0.07, 0.07) + 1e-4);
    terrain->attach(block.surface.mesh, steel(), block.state());
    blocks.push_back(block);
  }
  void run(int steps) {
    forces.resize(blocks.size());
    sums.resize(blocks.size());
    for (int i = 0; i < steps; ++i) {
      std::vector<SurfaceState> targets;
      for (const Block& block : blocks) targets.push_back(block.state());
      const Outcome status = terrain->advance(targets, kStep, 1, forces, sums);
      ASSERT_TRUE(status.ok) << status.message("terrain");
      for (std::size_t k = 0; k < blocks.size(); ++k) {
        blocks[k].advance(forces[k]);
        worst_force_residual = std::max(worst_force_residual, sums[k].transfer_force_residual);
        worst_moment_residual = std::max(worst_moment_residual, sums[k].transfer_moment_residual);
        ASSERT_LT((sums[k].normal + sums[k].tangential - sums[k].force).norm(), 1e-12);
      }
    }
  }
};

TEST(SurfaceCoupling, four_blocks_on_one_bed_each_feel_their_own_weight) {
  dem::DemOptions options = small_bin(0.84);
  options.cohesion = 20e3;  // a bed that carries the blocks after a few millimetres
  Scene scene(options);
  const double masses[] = {10.0, 15.0, 20.0, 25.0};
  for (int k = 0; k < 4; ++k) scene.put(0.12 + 0.2 * k, masses[k]);
  const TerrainState before = scene.terrain->gather_state();
  constexpr int kFall = 4000, kWindow = 1500;
  scene.run(kFall);
  std::vector<Vec3> impulse_before;
  for (const Block& block : scene.blocks) impulse_before.push_back(block.impulse);
  scene.run(kWindow);
  for (int k = 0; k < 4; ++k) {
    const double mean = (scene.blocks[k].impulse - impulse_before[k]).z() / (kWindow * kStep);
    EXPECT_NEAR(mean / (masses[k] * kStandardGravity), 1.0, 5e-3) << "block " << k;
    EXPECT_LT(std::abs(scene.blocks[k].velocity.z()), 1e-3) << "block " << k;
  }

  // What the grains received is what the blocks received; both sides' momentum accounts close on their own.
  const TerrainState after = scene.terrain->gather_state();
  Vec3 received = Vec3::Zero();
  for (const Block& block : scene.blocks) received += block.impulse;
  const double scale = received.norm();
  EXPECT_LT((after.momenta.surface_impulse - before.momenta.surface_impulse + received).norm() / scale, 1e-12);
  const double grain_mass = 4.0 / 3.0 * M_PI * 1e-6 * 2500.0 * static_cast<double>(scene.terrain->size());
  const Vec3 gravity(0.0, 0.0, -kStandardGravity * grain_mass * (kFall + kWindow) * kStep);
  const Vec3 change = after.momenta.grains - before.momenta.grains;
  const Vec3 given = gravity + (after.momenta.wall_impulse - before.momenta.wall_impulse) +
                     (after.momenta.surface_impulse - before.momenta.surface_impulse);
  EXPECT_LT((change - given).norm() / scale, 1e-9);
  EXPECT_LT(scene.worst_force_residual, 1e-12);
  EXPECT_LT(scene.worst_moment_residual, 1e-12);
}

TEST(SurfaceCoupling, no_grain_passes_through_a_plate_that_is_rammed_into_the_bed) {
  Scene scene(small_bin(0.4));
  scene.put(0.2, 1.0);
  Block& block = scene.blocks.front();
  const double bottom = block.position.z();
  const int steps = 600;  // 2 m/s for 36 ms would be the whole bed: stop after 30 mm
  int inside = 0;
  for (int i = 0; i < steps; ++i) {
    block.velocity = Vec3(0.0, 0.0, bottom - block.position.z() < 0.03 ? -2.0 : 0.0);
    const SurfaceState target = block.state();
    NodalForces forces;
    ContactSums sums;
    const Outcome status = scene.terrain->advance({&target, 1}, kStep, 1, {&forces, 1}, {&sums, 1});
    ASSERT_TRUE(status.ok) << status.message("terrain");
    block.position += kStep * block.velocity;
  }
  TerrainFrame frame;
  scene.terrain->gather_frame(frame);
  for (std::size_t g = 0; g < frame.radius.size(); ++g) {
    const Vec3 x(frame.position[3 * g], frame.position[3 * g + 1], frame.position[3 * g + 2]);
    const Vec3 local = x - block.position;
    if (std::abs(local.x()) < 0.055 && std::abs(local.y()) < 0.055 && local.z() > 0.0 && local.z() < 0.1) ++inside;
  }
  EXPECT_EQ(inside, 0);
}

}  // namespace
}  // namespace furrow::terrain
