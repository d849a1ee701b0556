// The grains behind the terrain interface: beds, cache, tires, state.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "protocol/core/field_hash.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/json_fields.hpp"
#include "terrain/dem/beds/bed_after_run.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/bed_fixture.hpp"
#include "tests/terrain/pressed_terrain.hpp"

namespace furrow::terrain {
namespace {

class DemTerrain : public dem::SmallBeds {
 protected:
  DemTerrain() { options_.cohesion = 20e3; }
  std::filesystem::path cached() const { return dem::bed_cache_file(dem::bed_digest(options_)); }
  std::unique_ptr<Terrain> prepared() const {
    auto terrain = make_dem_terrain(options_);
    terrain->prepare({});
    return terrain;
  }
  /// A square plate that presses down on the grains in the middle.
  PressedSurface plate_on(Terrain& terrain, double above = 0.0, const ContactMaterial& material = kRubber) const {
    const double z = terrain.gather_top_height(0.1, 0.2, -0.05, 0.05) + above;
    PressedSurface plate{
        testing::turned_down(testing::sheet(0.1, -0.05, 0.025, 4, 4, [=](double, double) { return z; }))};
    terrain.attach(plate.shape.mesh, material, plate.state);
    return plate;
  }

  static inline const ContactMaterial kRubber{2e7, 0.4, 0.9, 0.2, 2e6, 13.0, 0.0};
};

TEST_F(DemTerrain, bed_settles_and_stands_at_a_plausible_height) {
  const auto terrain = make_dem_terrain(options_);
  std::string said;
  terrain->prepare([&](const std::string& what, double) { said = what; });
  EXPECT_EQ(said, "settling the bed");
  const TerrainState s = terrain->gather_state();
  const double mass = 2500 * 4.0 / 3.0 * M_PI * 1e-6 * static_cast<double>(terrain->size());
  EXPECT_NEAR(s.floor_force, mass * 9.81, 1e-3 * mass * 9.81);
  const double height = terrain->gather_mean_height(0.03, 0.27, -0.08, 0.08),
               top = terrain->gather_top_height(0.03, 0.27, -0.08, 0.08);
  const double solid = mass / 2500 / (0.3 * 0.2 * height);
  EXPECT_GT(solid, 0.35);
  EXPECT_LT(solid, 0.64);
  EXPECT_GT(top, height);
  EXPECT_LT(top, height + 0.03);
  const TerrainEstimate e = estimate_dem_terrain(options_);
  EXPECT_NEAR(static_cast<double>(e.grains), static_cast<double>(terrain->size()), 0.1 * static_cast<double>(e.grains));
}

TEST_F(DemTerrain, run_from_cached_bed_equals_the_run_that_settled_it) {
  const auto first = prepared();
  ASSERT_TRUE(std::filesystem::exists(cached()));
  bool settled_again = false;
  const auto second = make_dem_terrain(options_);
  second->prepare([&](const std::string&, double) { settled_again = true; });
  EXPECT_FALSE(settled_again);
  EXPECT_EQ(hash_of(*first), hash_of(*second));
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(first->advance({}, 6e-5, 1, {}, {}).ok);
    ASSERT_TRUE(second->advance({}, 6e-5, 1, {}, {}).ok);
  }
  EXPECT_EQ(hash_of(*first), hash_of(*second));

  options_.bed = cached().string();
  const auto named = prepared();
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(named->advance({}, 6e-5, 1, {}, {}).ok);
  EXPECT_EQ(hash_of(*first), hash_of(*named));
  options_.radius = 0.011;
  EXPECT_THROW(make_dem_terrain(options_)->prepare({}), Error);
}

TEST_F(DemTerrain, damaged_cache_is_made_anew) {
  const auto first = prepared();
  {
    std::fstream file(cached(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(cached()) / 2));
    const std::string damage(4096, 'd');  // longer than any gap between arrays
    file.write(damage.data(), static_cast<std::streamsize>(damage.size()));
  }
  EXPECT_THROW(dem::read_bed(cached()), Error);
  bool settled_again = false;
  const auto second = make_dem_terrain(options_);
  second->prepare([&](const std::string&, double) { settled_again = true; });
  EXPECT_TRUE(settled_again);
  EXPECT_EQ(hash_of(*first), hash_of(*second));
  EXPECT_NO_THROW(dem::read_bed(cached()));
  for (const auto& entry : std::filesystem::directory_iterator(cached().parent_path()))
    EXPECT_EQ(entry.path().extension(), ".h5");
}

/// Files of a cache that were renamed.
TEST_F(DemTerrain, a_bed_under_the_name_of_another_is_made_anew) {
  dem::DemOptions other = options_;
  other.seed = 2;
  make_dem_terrain(other)->prepare({});
  const auto first = prepared();
  std::filesystem::rename(dem::bed_cache_file(dem::bed_digest(other)), cached());
  const auto second = prepared();
  EXPECT_EQ(hash_of(*first), hash_of(*second));
}

/// Changes the value.
void change(std::string& value) { value = value == "walls" ? "periodic" : value + "_other"; }
void change(bool& value) { value = !value; }
void change(int& value) { value += 1; }
void change(double& value) { value = 1.25 * value + 0.125; }

TEST_F(DemTerrain, digest_changes_with_every_key_that_decides_the_bits_of_a_bed_and_with_no_other) {
  const std::string digest = dem::bed_digest(options_);
  dem::DemOptions other = options_;
  other.threads = 7, other.settle_threads = 3, other.step = 1e-5, other.contact_tangents = true;
  EXPECT_EQ(dem::bed_digest(other), digest);
  other = options_, other.seed = 2;
  EXPECT_NE(dem::bed_digest(other), digest);
  EXPECT_EQ(dem::bed_digest(options_, arithmetic_id()), digest);
  EXPECT_NE(dem::bed_digest(options_, "that of another build"), digest);
  // The digest asks for the law itself: the settling step depends on it.
  other = options_, other.law = "hertz_tanh";
  EXPECT_NE(dem::bed_digest(other), digest);
  const std::size_t count = field_names<dem::DemOptions>(role::none).size();
  for (std::size_t place = 0; place < count; ++place) {
    other = options_;
    std::size_t here = 0;
    Field changed{""};
    visit_fields(other, [&](auto& value, const Field& field) {
      if (here++ != place || std::string(field.name) == "law" || std::string(field.name) == "bed") return;
      changed = field;
      change(value);
    });
    EXPECT_EQ(dem::bed_digest(other) != digest, changed.is(role::bed)) << changed.name;
  }
}

TEST_F(DemTerrain, digest_does_not_know_of_keys_that_are_the_default) {
  // Hash of an object whose fields are all the default: no field counts.
  Hash plain, with;
  with.add("before");
  plain.add("before");
  add_fields(with, dem::DemOptions(), role::bed);
  EXPECT_EQ(with.value(), plain.value());
  dem::DemOptions other;
  other.radius = 0.01;
  add_fields(with, other, role::bed);
  EXPECT_NE(with.value(), plain.value());
}

/// Grains would fall through such a surface, as there is no force.
TEST_F(DemTerrain, refuses_a_material_that_its_law_cannot_use_by_name) {
  const auto complaint = [&](const char* law, const ContactMaterial& material) {
    options_.law = law;
    const auto terrain = prepared();
    return refusal(ExitCode::bad_input, [&] { plate_on(*terrain, 1e-4, material); });
  };
  ContactMaterial soft = kRubber;
  soft.young_modulus = 0.0;
  EXPECT_EQ(complaint("mindlin", soft),
            "surface 0: key 'contact.young_modulus': is 0, expected above 0 Pa for law 'mindlin'");
  EXPECT_EQ(complaint("hertz_tanh", soft), "");
  ContactMaterial other = kRubber;
  other.normal_stiffness = 0.0;
  EXPECT_EQ(complaint("hertz_tanh", other),
            "surface 0: key 'contact.normal_stiffness': is 0, expected above 0 N/m^1.5 for law 'hertz_tanh'");
  EXPECT_EQ(complaint("mindlin", other), "");
}

TEST_F(DemTerrain, plate_books_force_momentum_and_energy) {
  options_.activity = false;
  for (const auto& [law, rolling] : {std::pair("mindlin", 0.0), {"mindlin", 0.3}, {"hertz_tanh", 0.0}}) {
    options_.law = law;
    options_.rolling_friction = rolling;
    const auto terrain = prepared();
    PressedSurface press = plate_on(*terrain, 1e-4);
    const TerrainState before = terrain->gather_state();
    const double dt = 6e-5;
    const Outcome status = press.move(*terrain, Vec3(0.1, 0.0, -0.2), 1000, dt, 2);
    ASSERT_TRUE(status.ok) << status.message("terrain");
    const TerrainState after = terrain->gather_state();
    const ContactSums& sums = press.sums[0];

    EXPECT_GT(press.impulse.z(), 0.05);
    EXPECT_LT((sums.force - sums.normal - sums.tangential).norm(), 1e-12 * sums.force.norm());
    Vec3 nodal = Vec3::Zero();
    for (const Vec3& f : press.forces[0].force) nodal += f;
    EXPECT_LT((nodal - sums.force).norm(), 1e-10 * sums.force.norm());
    EXPECT_LT(sums.transfer_force_residual, 1e-12);
    EXPECT_LT(sums.transfer_moment_residual, 1e-12);
    EXPECT_LT((press.impulse + after.momenta.surface_impulse).norm(), 1e-11 * press.impulse.norm());

    const double mass = 2500 * 4.0 / 3.0 * M_PI * 1e-6 * static_cast<double>(terrain->size());
    const Vec3 change = after.momenta.grains - before.momenta.grains - after.momenta.surface_impulse -
                        after.momenta.wall_impulse + Vec3(0, 0, mass * 9.81 * 1000 * dt);
    EXPECT_LT(change.norm(), 1e-10 * mass * 9.81 * 1000 * dt) << law;

    // The plate's work on the grains equals the increase of their energy plus their losses, up to the errors of step
    // and samples.
    const TerrainEnergies &from = before.energies, &to = after.energies;
    EXPECT_NEAR(to.surface_work, -press.work, 1e-12 * std::abs(press.work));
    EXPECT_NEAR(to.elastic_normal + to.cohesion, after.elastic_energy, 1e-12 * std::abs(to.cohesion));
    EXPECT_NEAR(to.kinetic + to.rotational, after.kinetic_energy, 1e-12 * to.kinetic);
    if (rolling > 0.0)
      EXPECT_GT(to.rolling_loss, to.sliding_loss);
    else
      EXPECT_GT(to.sliding_loss, to.normal_damping_loss);
    const double left = to.stored() - from.stored() + to.losses() - to.surface_work;
    RecordProperty(std::string("left_of_work_") + law + (rolling > 0.0 ? "_rolling" : ""),
                   std::to_string(left / to.surface_work));
    EXPECT_LT(std::abs(left), 0.03 * to.surface_work + 3.0 * to.sample_error) << law;
    EXPECT_LT(to.sample_error, 0.05 * to.losses());
    const TerrainMomenta &p = before.momenta, &q = after.momenta;
    EXPECT_LT((q.grains - p.grains - q.gravity_impulse - q.wall_impulse - q.surface_impulse - q.sleep_impulse).norm(),
              1e-10 * q.gravity_impulse.norm());
    EXPECT_NEAR(q.gravity_impulse.z(), -mass * 9.81 * 1000 * dt, 1e-10 * q.gravity_impulse.norm());
  }
}

TEST_F(DemTerrain, impulses_are_the_momentum_and_what_sleep_took) {
  options_.activity = true;
  const auto terrain = prepared();
  PressedSurface press = plate_on(*terrain, 1e-4);
  const TerrainState before = terrain->gather_state();
  const double dt = 6e-5;
  ASSERT_TRUE(press.move(*terrain, Vec3(0.1, 0.0, -0.2), 1000, dt, 2).ok);
  const TerrainState after = terrain->gather_state();
  ASSERT_GT((after.momenta.sleep_impulse - before.momenta.sleep_impulse).norm(), 0.0);
  const double mass = 2500 * 4.0 / 3.0 * M_PI * 1e-6 * static_cast<double>(terrain->size());
  const Vec3 weight = mass * 1000 * dt * standard_gravity();
  const auto given = [](const TerrainState& s) -> Vec3 {
    return s.momenta.wall_impulse + s.momenta.surface_impulse + s.momenta.sleep_impulse - s.momenta.grains;
  };
  // Sleeping strips that are not evaluated keep the forces of the step in which they fell asleep.
  EXPECT_LT((given(after) - given(before) + weight).norm(), 1e-3 * weight.norm());

  const TerrainEnergies &from = before.energies, &to = after.energies;
  const double left = to.stored() - from.stored() + to.losses() - to.surface_work;
  EXPECT_GT(to.sleep_loss, 0.0);
  RecordProperty("left_of_work", std::to_string(left / to.surface_work));
  EXPECT_LT(std::abs(left), 0.03 * to.surface_work + 3.0 * to.sample_error);
}

TEST_F(DemTerrain, restored_terrain_with_a_tire_continues_bit_for_bit) {
  options_.rolling_friction = 0.1;
  const auto a = prepared();
  PressedSurface press = plate_on(*a);
  ASSERT_TRUE(press.move(*a, Vec3(0.3, 0.0, -0.3), 300, 6e-5).ok);
  Archive archive;
  a->save(archive);
  options_.threads = 2;
  const auto b = make_dem_terrain(options_);
  b->restore(archive);
  PressedSurface again = press;
  ASSERT_TRUE(press.move(*a, Vec3(0.3, 0.0, -0.1), 300, 6e-5).ok);
  ASSERT_TRUE(again.move(*b, Vec3(0.3, 0.0, -0.1), 300, 6e-5).ok);
  EXPECT_EQ(hash_of(*a), hash_of(*b));
  EXPECT_EQ(press.forces[0].force, again.forces[0].force);
}

TEST_F(DemTerrain, bed_after_a_plate_lies_until_it_rests_and_starts_another_run) {
  const auto a = prepared();
  const double before = a->gather_mean_height(0.12, 0.18, -0.03, 0.03);
  PressedSurface press = plate_on(*a);
  ASSERT_TRUE(press.move(*a, Vec3(0.0, 0.0, -0.3), 1000, 6e-5).ok);
  ASSERT_TRUE(press.move(*a, Vec3(0.0, 0.0, 0.3), 500, 6e-5).ok);
  Archive run;
  a->save(run);
  dem::SettleResult rest;
  int told = 0;
  const Archive bed = dem::bed_after_run(
      run, options_, 0.02, [&](const std::string&, double) { ++told; }, rest);
  EXPECT_TRUE(rest.settled);
  EXPECT_GE(rest.time, 0.02);
  EXPECT_LT(rest.force_ratio, dem::kSettledForceRatio);
  EXPECT_LT(rest.speed, dem::kRestSpeed);
  EXPECT_GT(told, 0);
  options_.bed = (folder() / "bed.h5").string();
  dem::write_bed(options_.bed, bed);
  const auto b = prepared();
  EXPECT_EQ(b->size(), a->size());
  EXPECT_LT(b->gather_mean_height(0.12, 0.18, -0.03, 0.03), before - 2e-3) << "the plate's print is gone";
  struct Stop {};
  EXPECT_THROW(dem::bed_after_run(
                   run, options_, 0.02, [](const std::string&, double) { throw Stop{}; }, rest),
               Stop);
}

TEST_F(DemTerrain, tire_that_reaches_the_floor_stops_the_run_with_a_message) {
  const auto terrain = prepared();
  PressedSurface plate = plate_on(*terrain, 0.1);
  const Outcome status = plate.move(*terrain, Vec3(0, 0, -4000), 1, 6e-5);
  EXPECT_FALSE(status.ok);
  EXPECT_TRUE(holds(status.detail, "floor"));
  const testing::Surface outside = testing::under_side(-0.05, 0.05, -0.05, 0.05, 0.2);
  EXPECT_THROW(terrain->attach(outside.mesh, kRubber, testing::at_rest(outside)), Error);
}

TEST_F(DemTerrain, unstable_step_is_refused_by_number_unless_allowed) {
  options_.step = 5e-4;
  expect_refused(ExitCode::bad_input, {"run.step"}, [&] { make_dem_terrain(options_); });
  options_.allow_unstable_step = true;
  EXPECT_NO_THROW(make_dem_terrain(options_));
  options_.step = 6e-5;
  options_.allow_unstable_step = false;
  options_.law = "hertz_tanh";
  options_.friction_impulse_limit = false;
  EXPECT_THROW(make_dem_terrain(options_), Error);
  EXPECT_EQ(estimate_dem_terrain(options_).stable_reason, "friction viscosity");
}

TEST_F(DemTerrain, bad_values_are_refused_by_key) {
  for (const auto& [key, spoil] : std::initializer_list<std::pair<const char*, void (*)(dem::DemOptions&)>>{
           {"terrain.radius", [](dem::DemOptions& o) { o.radius = -1; }},
           {"terrain.density", [](dem::DemOptions& o) { o.density = std::nan(""); }},
           {"terrain.layers", [](dem::DemOptions& o) { o.layers = 0; }},
           {"terrain.width", [](dem::DemOptions& o) { o.width = 0.01; }},
           {"terrain.law", [](dem::DemOptions& o) { o.law = "hooke"; }}}) {
    dem::DemOptions bad = options_;
    spoil(bad);
    expect_refused(ExitCode::bad_input, {key}, [&] { make_dem_terrain(bad); });
  }
}

TEST(UsefulThreads, small_beds_have_one_and_nobody_gets_more_than_asked_for) {
  EXPECT_EQ(useful_threads(8, 0.0), 1);
  EXPECT_EQ(useful_threads(8, 2623.0), 1);
  EXPECT_EQ(useful_threads(8, 5249.0), 2);
  EXPECT_EQ(useful_threads(8, 1e6), 8);
}

}  // namespace
}  // namespace furrow::terrain
