// The terrain on an emulated GPU beside that of the processor, from the same bed: tires, accounts, checkpoints, steps
// in parts, and what it refuses.
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/dem_spec.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/gpu/gpu_terrain.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/bed_fixture.hpp"
#include "tests/terrain/pressed_terrain.hpp"

namespace furrow::terrain {
namespace {

class GpuTerrain : public dem::SmallBeds {
 protected:
  GpuTerrain() {
    options_.cohesion = 20e3;
    options_.activity = false;
  }
  /// Both start from one settled bed.
  void settle() {
    make_dem_terrain(options_)->prepare({});
    options_.bed = dem::bed_cache_file(dem::bed_digest(options_)).string();
  }
  std::unique_ptr<Terrain> made(const char* device) {
    dem::DemOptions options = options_;
    options.device = device;
    std::unique_ptr<Terrain> terrain = dem::make_dem_spec(options)->make(options);
    return terrain;
  }
  std::unique_ptr<Terrain> prepared(const char* device) {
    auto terrain = made(device);
    terrain->prepare({});
    return terrain;
  }
  PressedSurface plate_on(Terrain& terrain, double above = 0.0) const {
    const double z = terrain.gather_top_height(0.1, 0.2, -0.05, 0.05) + above;
    PressedSurface plate{
        testing::turned_down(testing::sheet(0.1, -0.05, 0.025, 4, 4, [=](double, double) { return z; }))};
    terrain.attach(plate.shape.mesh, kRubber, plate.state);
    return plate;
  }

  static inline const ContactMaterial kRubber{2e7, 0.4, 0.9, 0.2, 2e6, 13.0, 0.0};
};

TEST_F(GpuTerrain, pushes_a_plate_as_the_processor_does) {
  for (const double rolling : {0.0, 0.2}) {
    options_.bed.clear();
    options_.rolling_friction = rolling;
    settle();
    const auto cpu = prepared("cpu"), gpu = prepared("gpu");
    EXPECT_EQ(cpu->size(), gpu->size());
    EXPECT_NEAR(cpu->gather_mean_height(0.0, 0.3, -0.1, 0.1), gpu->gather_mean_height(0.0, 0.3, -0.1, 0.1), 1e-9);
    PressedSurface on_cpu = plate_on(*cpu), on_gpu = plate_on(*gpu);
    const Vec3 velocity(0.1, 0.02, -0.4);
    double force = 0.0;
    for (int k = 0; k < 60; ++k) {
      ASSERT_TRUE(on_cpu.move(*cpu, velocity, 1, 2.4e-4, 4).ok);
      ASSERT_TRUE(on_gpu.move(*gpu, velocity, 1, 2.4e-4, 4).ok);
      force = std::max(force, on_cpu.sums[0].force.norm());
      ASSERT_LT((on_cpu.sums[0].force - on_gpu.sums[0].force).norm(), 1e-3 * force + 1e-3) << k;
      ASSERT_EQ(on_cpu.sums[0].contacts, on_gpu.sums[0].contacts) << k;
      EXPECT_LT(on_gpu.sums[0].transfer_force_residual, 1e-10);
      EXPECT_LT(on_gpu.sums[0].transfer_moment_residual, 1e-9);
      Vec3 nodal = Vec3::Zero();
      for (const Vec3& f : on_gpu.forces[0].force) nodal += f;
      EXPECT_LT((nodal - on_gpu.sums[0].force).norm(), 1e-9 * force + 1e-9);
    }
    EXPECT_GT(force, 20.0);
    EXPECT_NEAR(on_cpu.work, on_gpu.work, 1e-3 * std::abs(on_cpu.work));
    const TerrainState a = cpu->gather_state(), b = gpu->gather_state();
    EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, 0.02 * a.kinetic_energy);
    EXPECT_NEAR(a.elastic_energy, b.elastic_energy, 0.05 * std::abs(a.elastic_energy));
    EXPECT_NEAR(a.energies.losses(), b.energies.losses(), 0.05 * a.energies.losses());
  }
}

TEST_F(GpuTerrain, keeps_the_accounts_of_momentum_and_energy) {
  options_.rolling_friction = 0.2;
  settle();
  const auto terrain = prepared("gpu");
  PressedSurface plate = plate_on(*terrain);
  const TerrainState before = terrain->gather_state();
  ASSERT_TRUE(plate.move(*terrain, {0.1, 0.02, -0.4}, 100, 1.2e-4, 2).ok);
  const TerrainState s = terrain->gather_state();
  const TerrainMomenta& p = s.momenta;
  const Vec3 residual = p.grains - before.momenta.grains - p.gravity_impulse - p.wall_impulse - p.surface_impulse;
  EXPECT_LT(residual.norm(), 1e-11);
  EXPECT_LT((p.surface_impulse + plate.impulse).norm(), 1e-9);
  const TerrainEnergies& e = s.energies;
  const double gap = e.stored() - before.energies.stored() + e.losses() - e.surface_work;
  EXPECT_LT(std::abs(gap), 0.05 * e.losses());
  EXPECT_NEAR(e.surface_work, -plate.work, 1e-12);
}

TEST_F(GpuTerrain, continues_from_a_saved_state_with_the_same_bits) {
  options_.rolling_friction = 0.2;
  settle();
  const auto first = prepared("gpu");
  PressedSurface plate = plate_on(*first);
  ASSERT_TRUE(plate.move(*first, {0.1, 0.02, -0.4}, 60, 1.2e-4, 2).ok);
  Archive archive;
  first->save(archive);
  const auto second = made("gpu");
  second->attach(plate.shape.mesh, kRubber, plate.state);  // as a run that is resumed does
  second->gather_state();
  second->restore(archive);
  EXPECT_EQ(hash_of(*first), hash_of(*second));
  EXPECT_EQ(first->gather_state().elastic_energy, second->gather_state().elastic_energy);
  EXPECT_EQ(first->gather_state().floor_force, second->gather_state().floor_force);
  PressedSurface other = plate;
  ASSERT_TRUE(plate.move(*first, {-0.1, 0.0, -0.2}, 60, 1.2e-4, 2).ok);
  ASSERT_TRUE(other.move(*second, {-0.1, 0.0, -0.2}, 60, 1.2e-4, 2).ok);
  EXPECT_EQ(plate.impulse, other.impulse);
  EXPECT_EQ(hash_of(*first), hash_of(*second));
}

TEST_F(GpuTerrain, takes_steps_in_parts_while_contacts_are_too_hard) {
  settle();
  options_.step = 1e-4;
  const auto cpu = prepared("cpu"), gpu = prepared("gpu");
  PressedSurface on_cpu = plate_on(*cpu), on_gpu = plate_on(*gpu);
  for (PressedSurface* const plate : {&on_cpu, &on_gpu}) {
    Terrain& terrain = plate == &on_cpu ? *cpu : *gpu;
    ASSERT_TRUE(plate->move(terrain, {0.0, 0.0, -1.5}, 120, 1e-4).ok);
  }
  const TerrainState a = cpu->gather_state(), b = gpu->gather_state();
  EXPECT_GT(a.substeps_added, 10);
  EXPECT_NEAR(static_cast<double>(a.substeps_added), static_cast<double>(b.substeps_added),
              0.2 * static_cast<double>(a.substeps_added));
  EXPECT_EQ(a.most_parts, b.most_parts);
  EXPECT_NEAR(on_cpu.impulse.z(), on_gpu.impulse.z(), 0.02 * std::abs(on_cpu.impulse.z()));
}

TEST_F(GpuTerrain, settles_a_bed_of_its_own_as_deep_as_that_of_the_processor) {
  const auto cpu = prepared("cpu"), gpu = prepared("gpu");
  const double weight = 9.81 * 2500 * 4.0 / 3.0 * M_PI * 1e-6 * static_cast<double>(gpu->size());
  EXPECT_EQ(gpu->size(), cpu->size());
  const auto height = [](const Terrain& terrain) { return terrain.gather_mean_height(0.03, 0.27, -0.08, 0.08); };
  EXPECT_NEAR(height(*gpu), height(*cpu), 0.03 * height(*cpu));
  ASSERT_TRUE(gpu->advance({}, 6e-5, 1, {}, {}).ok);
  EXPECT_NEAR(gpu->gather_state().floor_force, weight, 2e-3 * weight);
  dem::DemOptions on_gpu = options_;
  on_gpu.device = "gpu";
  EXPECT_NE(dem::bed_digest(on_gpu), dem::bed_digest(options_));
  const auto again = prepared("gpu");
  ASSERT_TRUE(again->advance({}, 6e-5, 1, {}, {}).ok);
  EXPECT_EQ(hash_of(*again), hash_of(*gpu));
}

TEST_F(GpuTerrain, is_a_bed_for_another_pass) {
  settle();
  const auto gpu = prepared("gpu");
  dem::DemOptions on_gpu = options_;
  on_gpu.device = "gpu";
  Archive state;
  gpu->save(state);
  std::vector<Archive> parts;
  parts.push_back(state);
  const Archive joined = dem::make_dem_spec(on_gpu)->joined_state(std::move(parts), on_gpu);
  EXPECT_EQ(joined.get_int("terrain/count"), gpu->size());
}

TEST_F(GpuTerrain, refuses_what_it_does_not_do) {
  const auto expect_key = [&](const char* key, auto change) {
    dem::DemOptions options = options_;
    options.device = "gpu";
    change(options);
    expect_refused(ExitCode::bad_input, {key, "terrain.device 'gpu'"},
                   [&] { dem::make_dem_spec(options)->estimate(options); });
  };
  expect_key("terrain.size_spread", [](auto& o) { o.size_spread = 0.2; });
  expect_key("terrain.precision", [](auto& o) { o.precision = "double"; });
  expect_key("tire.contact_tangent", [](auto& o) { o.contact_tangents = true; });
}

}  // namespace
}  // namespace furrow::terrain
