// Grains that sleep: none wakes late, and a woken grain moves as if it had never slept.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "protocol/core/constants.hpp"
#include "tests/terrain/pressed_bed.hpp"

namespace furrow::terrain::dem {
namespace {

DemOptions bed_options(double cohesion) {
  DemOptions options;
  options.radius = 0.01;
  options.layers = 4;
  options.length = 1.2;
  options.width = 0.12;
  options.cohesion = cohesion;
  options.step = 6e-5;
  return options;
}

/// A plate that spans the bin's middle, 0.1 m long.
Plate middle_plate(GrainSolver& solver, const DemOptions& options, double z) {
  return {solver, options, testing::under_side(0.55, 0.65, -0.04, 0.04, z)};
}

TEST(Activity, bed_at_rest_falls_asleep_and_stays_where_it_is) {
  const DemOptions options = bed_options(20e3);
  GrainSolver solver = solver_of(options, settled_bed(options), true);
  const double height = solver.accounts().height / solver.grains().count;
  run(solver, options.step, 4000);
  EXPECT_EQ(solver.accounts().active, 0);
  EXPECT_EQ(solver.accounts().kinetic, 0.0);
  EXPECT_NEAR(solver.accounts().height / solver.grains().count, height, 0.01 * options.radius);
  const double weight = solver.params().grain.mass * kStandardGravity * solver.grains().count;
  EXPECT_NEAR(solver.accounts().floor_force, weight, 0.02 * weight);
}

/// Three grains that slide along x without friction and never meet.
struct SlidingGrains : FewGrains {
  double speed;  // m/s

  /// @param share of the limit of sleep
  SlidingGrains(double share, double step) {
    options.friction = 0.0;
    options.step = step;
    options.periodic_x = true;
    gravity = kStandardGravity;
    activity = true;
    speed = share * kSleepMeanSpeed * std::sqrt(kStandardGravity * options.radius);
  }
  GrainSolver make() const {
    const double z = resting_height();
    GrainSolver s = FewGrains::make({{0.1, 0.0, z, 0.0}, {0.3, 0.05, z, 0.0}, {0.45, -0.05, z, 0.0}});
    for (const int id : {0, 1, 2}) set_velocity(s, id, Vec3(speed, 0.0, 0.0));
    return s;
  }
};

TEST(Activity, momentum_of_sliding_grains_is_booked_when_they_fall_asleep) {
  const SlidingGrains sliding(0.4, 2e-5);
  const double speed = sliding.speed;
  GrainSolver s = sliding.make();
  for (int k = 0; k < 2 * kCalmSteps; ++k) s.step(sliding.options.step);
  ASSERT_EQ(s.accounts().active, 0);
  const double mass = s.params().grain.mass;
  EXPECT_EQ(s.accounts().velocity.norm(), 0.0);
  EXPECT_NEAR(s.accounts().momentum_removed.x(), 3 * mass * speed, 1e-12 * mass * speed);
  EXPECT_EQ(s.accounts().momentum_removed.y(), 0.0);
  const TerrainEnergies energies = s.reported_energies();
  EXPECT_NEAR(energies.sleep_loss / (1.5 * mass * speed * speed), 1.0, 1e-6);
  EXPECT_EQ(energies.kinetic + energies.rotational, 0.0);
}

/// Steps of one window of drift.
int window(const DemOptions& options) {
  return static_cast<int>(std::ceil(kSwayTime * std::sqrt(options.radius / kStandardGravity) / options.step));
}

// The lowest shear mode of a layer on a floor, u ∝ sin(π z/2h): neighbours move together, so contacts damp it little.
TEST(Activity, bed_that_only_sways_falls_asleep) {
  const DemOptions options = bed_options(40e3);
  const Archive archive = settled_bed(options);
  GrainSolver solver = solver_of(options, archive, true), awake = solver_of(options, archive, false);
  const double unit = std::sqrt(kStandardGravity * options.radius), height = solver.top();
  for (GrainSolver* s : {&solver, &awake})
    for (int g = 0; g < s->grains().count; ++g)
      s->grains().velocity[g].y += 0.08 * unit * std::sin(0.5 * std::numbers::pi * s->grains().position[g].z / height);
  double rms = 1.0;
  int steps = 0;
  for (; steps < 3 * window(options) && solver.accounts().active > 0; ++steps) {
    ASSERT_EQ(solver.step(options.step), -1);
    ASSERT_EQ(awake.step(options.step), -1);
    const double mass = awake.params().grain.mass * awake.grains().count;
    if (steps % kCalmSteps == 0) rms = 0.0;
    rms = std::max(rms, std::sqrt(2.0 * awake.accounts().kinetic / mass) / unit);
  }
  EXPECT_EQ(solver.accounts().active, 0);
  EXPECT_GT(rms, 1.2 * kSleepMeanSpeed) << "after " << steps << " steps: it did not sway";
}

TEST(Activity, grains_that_drift_stay_awake_however_even_their_motion) {
  const SlidingGrains sliding(1.5, 1e-4);
  const double speed = sliding.speed;
  GrainSolver s = sliding.make();
  for (int k = 0; k < 4 * window(sliding.options); ++k) s.step(sliding.options.step);
  EXPECT_EQ(s.accounts().active, 3);
  EXPECT_NEAR(s.accounts().velocity.x(), 3 * speed, 1e-9 * speed);
}

TEST(Activity, mean_contact_force_follows_the_load) {
  const DemOptions options = bed_options(20e3);
  const Archive bed = settled_bed(options);
  GrainSolver asleep = solver_of(options, bed, true), awake = solver_of(options, bed, false);
  for (GrainSolver* s : {&asleep, &awake}) run(*s, options.step, 1500);
  const double before = asleep.mean_contact_force(), top = awake.top();
  for (GrainSolver* s : {&asleep, &awake}) middle_plate(*s, options, top).move(Vec3(0, 0, -0.1), 2000);
  awake.step(options.step, true);
  const double all = awake.accounts().contact_force / static_cast<double>(awake.accounts().contacts);
  EXPECT_GT(all, 1.2 * before);
  EXPECT_NEAR(asleep.mean_contact_force(), all, 0.05 * all);
}

TEST(Activity, mean_contact_force_has_the_same_bits_after_a_restart_between_two_samples) {
  const DemOptions options = bed_options(20e3);
  GrainSolver solver = solver_of(options, settled_bed(options), true);
  run(solver, options.step, kSampleSteps + kSampleSteps / 2);
  GrainSolver again = restored(solver, 2);
  const double before = solver.mean_contact_force();
  for (int k = 0; k < 3 * kSampleSteps; ++k) {
    solver.step(options.step), again.step(options.step);
    ASSERT_EQ(solver.mean_contact_force(), again.mean_contact_force()) << k;
  }
  EXPECT_NE(solver.mean_contact_force(), before);
  EXPECT_EQ(hash_of(solver), hash_of(again));
}

// Sleeping strips between sleeping strips are not evaluated, so their sums must be in the saved state.
TEST(Activity, sums_have_the_same_bits_after_a_restart_of_a_bed_that_sleeps) {
  const DemOptions options = bed_options(5e3);
  GrainSolver solver = solver_of(options, settled_bed(options), true);
  run(solver, options.step, 4000);
  ASSERT_EQ(solver.accounts().active, 0);
  GrainSolver again = restored(solver);
  for (int k = 0; k < 2 * kSampleSteps; ++k) {
    solver.step(options.step), again.step(options.step);
    ASSERT_EQ(solver.accounts().contact_force, again.accounts().contact_force) << k;
  }
  EXPECT_GT(again.accounts().contact_force, 0.0);
  EXPECT_EQ(hash_of(solver), hash_of(again));
}

TEST(Activity, pressed_sleeping_bed_pushes_back_like_one_that_is_all_awake) {
  for (double cohesion : {0.0, 40e3}) {
    const DemOptions options = bed_options(cohesion);
    const Archive bed = settled_bed(options);
    GrainSolver asleep = solver_of(options, bed, true), awake = solver_of(options, bed, false);
    const int few = asleep.grains().count / 10;  // a grain without cohesion may roll for long
    for (int k = 0; k < 4000 || (k < 20000 && asleep.accounts().active >= few); ++k)
      asleep.step(options.step), awake.step(options.step);
    ASSERT_LT(asleep.accounts().active, few) << cohesion;
    const double from = awake.top();
    Plate some = middle_plate(asleep, options, from), all = middle_plate(awake, options, from);
    const auto [error, most] = difference_pressed(some, all);
    EXPECT_GT(most, 10.0);
    EXPECT_LT(error, 0.05 * most) << "cohesion " << cohesion;
    EXPECT_LT(asleep.accounts().active, asleep.grains().count);
  }
}

TEST(Activity, falling_grain_wakes_what_it_hits) {
  const DemOptions options = bed_options(5e3);
  GrainSolver solver = solver_of(options, settled_bed(options), true);
  run(solver, options.step, 4000);
  ASSERT_EQ(solver.accounts().active, 0);
  // A grain of the top layer is thrown along the bed and comes down elsewhere.
  Grains& grains = solver.grains();
  int thrown = 0;
  for (int g = 0; g < grains.count; ++g)
    if (grains.position[g].x < 0.2 && grains.position[g].z > grains.position[thrown].z) thrown = g;
  const int id = grains.id[thrown];
  const double start = grains.position[thrown].x;
  grains.velocity[thrown] = {1.5, 0.0, 2.5, 0.0};
  solver.wake(thrown);
  std::int64_t most = 0;
  for (int k = 0; k < 12000; ++k) {
    ASSERT_EQ(solver.step(options.step), -1);
    most = std::max(most, solver.accounts().active);
  }
  const Quad& end = grains.position[solver.index_of(id)];
  EXPECT_GT(end.x, start + 0.15);
  EXPECT_GT(most, 0);
  EXPECT_EQ(solver.accounts().active, 0);
}

}  // namespace
}  // namespace furrow::terrain::dem
