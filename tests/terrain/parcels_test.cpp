// Sleep across the bed: a wide strip sleeps in parcels, which changes only the time of a step.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/solver_state_check.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/pressed_bed.hpp"

namespace furrow::terrain::dem {
namespace {

DemOptions wide_options() {
  DemOptions options;
  options.radius = 0.01;
  options.layers = 3;
  options.length = 0.3;
  options.width = 1.3;
  options.cohesion = 20e3;
  options.step = 6e-5;
  return options;
}

GrainSolver bed(bool activity) {
  static const Archive kBed = settled_bed(wide_options());
  return solver_of(wide_options(), kBed, activity);
}

Plate plate_over(GrainSolver& solver, double x0, double x1, double y0, double y1, double z) {
  return {solver, wide_options(), testing::under_side(x0, x1, y0, y1, z)};
}
/// A plate over a corner of the bed, a little above it.
Plate corner_plate(GrainSolver& solver, double z) { return plate_over(solver, 0.1, 0.2, -0.6, -0.5, z); }
Plate corner_plate(GrainSolver& solver) { return corner_plate(solver, solver.top()); }

/// Grains of the parcels that lie beyond y, or of those that sleep.
std::int64_t grains_beyond(const GrainSolver& s, double y, bool asleep = false) {
  std::int64_t count = 0;
  for (int k = 0; k < s.strips().count(); ++k)
    for (int p = 0; p < s.strips().across(); ++p)
      if ((s.strips()[k].parcels[p].asleep || !asleep) && s.strips().parcel_between(p, y, 1e300))
        count += s.strips()[k].parcels[p].part.grains();
  return count;
}

void rest(GrainSolver& s, int steps) { run(s, wide_options().step, steps); }

TEST(Parcels, narrow_strips_are_whole_and_wide_ones_are_cut) {
  EXPECT_EQ(parcels_across(1), 1);
  EXPECT_EQ(parcels_across(kParcelColumns * kFewestParcels - 1), 1);
  EXPECT_EQ(parcels_across(kParcelColumns * kFewestParcels), kFewestParcels);
  EXPECT_EQ(bed(false).strips().across(), 1);
  const GrainSolver cut = bed(true);
  const Strips& strips = cut.strips();
  ASSERT_GE(strips.across(), kFewestParcels);
  EXPECT_TRUE(strips.parcel_between(0, -9.0, -8.0));  // the outer ones reach beyond the sides
  EXPECT_FALSE(strips.parcel_between(1, -9.0, -0.65));
  for (int k = 0; k < strips.count(); ++k) {
    StripPart at;
    for (const Parcel& parcel : strips[k].parcels) {
      EXPECT_EQ(parcel.part.first, at.last);
      EXPECT_EQ(parcel.part.pair_first, at.pair_last);
      EXPECT_EQ(parcel.part.wall_first, at.wall_last);
      at = parcel.part;
      for (int p = at.pair_first; p < at.pair_last; ++p)
        ASSERT_TRUE(strips[k].grain_i(p) >= at.first && strips[k].grain_i(p) < at.last);
      for (int n = at.wall_first; n < at.wall_last; ++n)
        ASSERT_TRUE(strips[k].walls[n].grain >= at.first && strips[k].walls[n].grain < at.last);
    }
    EXPECT_EQ(at.last, strips[k].grains());
    EXPECT_EQ(at.pair_last, strips[k].pairs);
    EXPECT_EQ(at.wall_last, static_cast<int>(strips[k].walls.size()));
  }
}

TEST(Parcels, awake_bed_has_the_bits_that_it_has_uncut) {
  // A plate above the whole bed keeps every parcel awake. Calm parcels are evaluated separately whenever they might
  // fall asleep.
  GrainSolver cut = bed(true), whole = bed(false);
  Plate over_cut = plate_over(cut, 0.01, 0.29, -0.64, 0.64, cut.top() + 1e-3);
  Plate over_whole = plate_over(whole, 0.01, 0.29, -0.64, 0.64, whole.top() + 1e-3);
  over_cut.move(Vec3::Zero(), 3 * kCalmSteps);
  over_whole.move(Vec3::Zero(), 3 * kCalmSteps);
  EXPECT_EQ(cut.accounts().active, cut.grains().count);
  EXPECT_EQ(hash_of(cut), hash_of(whole));
  over_cut.move(Vec3(0.3, 0.3, -0.3), 300);
  over_whole.move(Vec3(0.3, 0.3, -0.3), 300);
  ASSERT_EQ(cut.accounts().active, cut.grains().count);
  EXPECT_GT(over_cut.work * over_cut.work, 0.0);
  EXPECT_EQ(over_cut.work, over_whole.work);
  EXPECT_EQ(hash_of(cut), hash_of(whole));
  // Rounding differs: sums over some contacts are in single precision.
  EXPECT_NEAR(cut.accounts().elastic / whole.accounts().elastic, 1.0, 1e-8);
  EXPECT_NEAR(cut.accounts().kinetic / whole.accounts().kinetic, 1.0, 1e-12);
  EXPECT_EQ(cut.accounts().contacts, whole.accounts().contacts);
}

TEST(Parcels, wheel_on_one_side_leaves_the_other_asleep) {
  GrainSolver solver = bed(true);
  rest(solver, 3000);
  ASSERT_LT(solver.accounts().active, solver.grains().count / 20);
  Plate plate = corner_plate(solver);
  plate.move(Vec3(0, 0, -0.1), 1000);
  EXPECT_GT(plate.move(Vec3(0, 0, -0.1), 500).z(), 10.0);
  EXPECT_GT(solver.accounts().active, solver.grains().count / 50);
  EXPECT_LT(solver.accounts().active, solver.grains().count / 2);
  // Strips under the plate are awake there and asleep elsewhere.
  EXPECT_GT(grains_beyond(solver, 0.0, true), 95 * grains_beyond(solver, 0.0) / 100);
}

TEST(Parcels, disturbance_wakes_across_one_parcel_per_step) {
  GrainSolver solver = bed(true);
  rest(solver, 3000);
  const int last = solver.strips().across() - 1;
  const auto asleep = [&](int p) {
    int count = 0;
    for (int k = 0; k < solver.strips().count(); ++k) count += solver.strips()[k].parcels[p].asleep;
    return count;
  };
  ASSERT_EQ(asleep(last), solver.strips().count());
  Grains& grains = solver.grains();
  for (int g = 0; g < grains.count; ++g)
    if (grains.position[g].y < -0.55) grains.velocity[g] = {0.0, 2.0, 0.0, 0.0}, solver.wake(g);
  std::vector<int> awake_after(last + 1, -1);
  for (int k = 0; k < 1000; ++k) {
    ASSERT_EQ(solver.step(wide_options().step), -1);
    for (int p = 0; p <= last; ++p)
      if (awake_after[p] < 0 && asleep(p) < solver.strips().count()) awake_after[p] = k;
  }
  // Its range depends on damping.
  EXPECT_GT(awake_after[4], 0);
  for (int p = 1; p <= last && awake_after[p] >= 0; ++p) EXPECT_GE(awake_after[p], awake_after[p - 1]) << p;
}

TEST(Parcels, sleeping_bed_feels_the_same_pressure) {
  GrainSolver some = bed(true), all = bed(false);
  rest(some, 3000);
  rest(all, 3000);
  const double from = all.top();
  Plate on_some = corner_plate(some, from), on_all = corner_plate(all, from);
  const auto [error, most] = difference_pressed(on_some, on_all);
  EXPECT_GT(most, 10.0);
  EXPECT_LT(error, 0.05 * most);
  EXPECT_LT(some.accounts().active, some.grains().count / 2);
}

TEST(Parcels, momentum_and_energy_close_while_some_sleep) {
  GrainSolver solver = bed(true);
  solver.reset_accounts();
  const double mass = solver.params().grain.mass;
  const Vec3 before = mass * solver.accounts().velocity;
  const TerrainEnergies from = solver.reported_energies();
  rest(solver, 1000);
  Plate plate = corner_plate(solver);
  plate.move(Vec3(0, 0, -0.1), 1500);
  plate.move(Vec3(0.1, 0.1, 0), 1500);
  const Accounts& a = solver.accounts();
  EXPECT_GT(a.active, 0);
  EXPECT_LT(a.active, solver.grains().count);
  const Vec3 weight = solver.gravity_impulse();
  EXPECT_NEAR(weight.z(), -mass * kStandardGravity * solver.grains().count * 4000 * wide_options().step,
              1e-9 * weight.norm());
  const Vec3 given = weight + a.wall_impulse + a.surface_impulse - a.momentum_removed;
  EXPECT_LT((mass * a.velocity - before - given).norm(), 1e-3 * weight.norm());
  const TerrainEnergies to = solver.reported_energies();
  EXPECT_GT(to.sleep_loss, 0.0);
  const double left = to.stored() - from.stored() + to.losses() + plate.work;
  RecordProperty("left_of_work", std::to_string(-left / plate.work));
  EXPECT_LT(std::abs(left), 0.03 * std::abs(plate.work) + 3.0 * to.sample_error);
}

TEST(Parcels, same_bits_for_one_and_two_threads_and_after_a_restart_with_some_asleep) {
  GrainSolver one = bed(true), two = bed(true);
  two.set_threads(2);
  Plate first = corner_plate(one), second = corner_plate(two);
  for (Plate* plate : {&first, &second}) plate->move(Vec3(0, 0.05, -0.1), 777);
  ASSERT_GT(one.accounts().active, 0);
  ASSERT_LT(one.accounts().active, one.grains().count);
  EXPECT_EQ(hash_of(one), hash_of(two));
  GrainSolver again = restored(one);
  Plate third(again, first);
  for (int k = 0; k < 600; ++k) {
    for (Plate* plate : {&first, &third}) plate->move(Vec3(0, -0.2, 0.02), 1);
    ASSERT_EQ(one.accounts().active, again.accounts().active) << k;
    ASSERT_EQ(one.accounts().elastic, again.accounts().elastic) << k;
    ASSERT_EQ(one.accounts().floor_force, again.accounts().floor_force) << k;
    ASSERT_EQ(one.mean_contact_force(), again.mean_contact_force()) << k;
  }
  EXPECT_EQ(hash_of(one), hash_of(again));
  EXPECT_EQ(one.accounts().slept, again.accounts().slept);
  EXPECT_EQ(one.accounts().momentum_removed, again.accounts().momentum_removed);
  const TerrainEnergies e = one.reported_energies(), f = again.reported_energies();
  EXPECT_EQ(e.losses(), f.losses());
  EXPECT_EQ(e.stored(), f.stored());
}

TEST(Parcels, grain_that_is_sorted_into_another_sleeping_parcel_is_counted_once) {
  FewGrains few;
  few.options.friction = 0.0;
  few.options.step = 2e-5;
  few.options.length = 0.6;
  few.options.width = 2.6;
  few.options.radius = 0.02;
  few.gravity = kStandardGravity;
  few.activity = true;
  const double radius = few.options.radius;
  const double z = few.resting_height();
  const int columns = static_cast<int>(few.options.width / (2.6 * radius)), across = parcels_across(columns);
  ASSERT_GT(across, 1);
  const double side = -0.5 * few.options.width + few.options.width / columns * (3 * columns / across);
  // One drifts over the side of its parcel by less than the distance that renews the lists; another will be thrown.
  GrainSolver s = few.make({{0.3, side - 3e-7, z, 0.0}, {0.3, 1.0, z, 0.0}});
  const double speed = 0.4 * kSleepMeanSpeed * std::sqrt(kStandardGravity * radius);
  set_velocity(s, 0, Vec3(0.0, speed, 0.0));
  for (int k = 0; k < 2 * kCalmSteps; ++k) s.step(few.options.step);
  ASSERT_EQ(s.accounts().active, 0);
  ASSERT_EQ(s.accounts().contacts, 2);
  ASSERT_GT(position(s, 0).y(), side);
  set_velocity(s, 1, Vec3(0.0, 1.0, 0.0));
  s.wake(s.index_of(1));
  const std::int64_t before = s.strips().resorted();
  for (int k = 0; k < 1000 && s.strips().resorted() == before; ++k) s.step(few.options.step);
  ASSERT_GT(s.strips().resorted(), before);
  EXPECT_EQ(s.accounts().active, 1);
  s.step(few.options.step);
  EXPECT_EQ(s.accounts().contacts, 2);
  s.wake(s.index_of(0));
  s.step(few.options.step);
  EXPECT_EQ(s.accounts().active, 2);
  EXPECT_EQ(s.accounts().contacts, 2);
}

TEST(Parcels, bed_that_slept_by_other_parcels_wakes_and_a_run_is_refused) {
  GrainSolver asleep = bed(true);
  rest(asleep, 2000);
  ASSERT_LT(asleep.accounts().active, asleep.grains().count / 2);
  Archive saved;
  asleep.save(saved);
  EXPECT_EQ(saved_across(saved), asleep.strips().across());
  EXPECT_NO_THROW(require_same_parcels(saved, asleep.strips()));

  GrainSolver never = solver_of(wide_options(), saved, false);  // its grains may not sleep
  EXPECT_EQ(hash_of(never), hash_of(asleep));
  rest(never, 1);
  EXPECT_EQ(never.accounts().active, never.grains().count);
  // Sums of sleeping grains are those of their last evaluation, one step before they stopped.
  EXPECT_NEAR(never.accounts().elastic / asleep.accounts().elastic, 1.0, 1e-3);
  EXPECT_NEAR(static_cast<double>(never.accounts().contacts) / static_cast<double>(asleep.accounts().contacts), 1.0,
              2e-3);
  const std::string told = refusal(ExitCode::io, [&] { require_same_parcels(saved, never.strips()); });
  EXPECT_TRUE(told.starts_with("saved state 'parcels/across' is ")) << told;
}

TEST(Parcels, periodic_sides_sleep_and_wake_around_the_seam) {
  FewGrains few;
  few.options.step = 2e-5;
  few.options.length = 0.6;
  few.options.width = 2.6;
  few.options.sides = "periodic";
  few.options.radius = 0.02;
  few.gravity = kStandardGravity;
  few.activity = true;
  std::vector<Quad> row;
  const int n = 65;
  for (int k = 0; k < n; ++k) row.push_back({0.3, -1.3 + 2.6 * (k + 0.5) / n, 0.02, 0.0});
  GrainSolver cut = few.make(row);
  few.activity = false;
  GrainSolver whole = few.make(row);
  for (GrainSolver* s : {&cut, &whole}) run(*s, few.options.step, 4000);
  EXPECT_EQ(cut.accounts().active, 0);
  for (GrainSolver* s : {&cut, &whole}) {
    set_velocity(*s, 0, Vec3(0.0, -1.0, 0.0));  // over the seam
    s->wake(s->index_of(0));
    run(*s, few.options.step, 2000);
  }
  for (const int id : {0, 1, n - 2, n - 1})
    EXPECT_NEAR((position(cut, id) - position(whole, id)).norm(), 0.0, 1e-4) << id;
}

}  // namespace
}  // namespace furrow::terrain::dem
