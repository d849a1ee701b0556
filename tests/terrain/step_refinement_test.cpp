// Hard contacts: the bed makes smaller steps while they need them, and only then.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "protocol/core/no_step_helps.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/refinement/step_refinement.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/bed_fixture.hpp"
#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/pressed_terrain.hpp"

namespace furrow::terrain {
namespace {

namespace fs = std::filesystem;
using dem::FewGrains, dem::GrainSolver, dem::StepRefinement;

/// Two grains that meet head on with speed `v` each, in a bin without gravity.
struct Collision {
  FewGrains few;
  double gap = 5e-4;  // at the beginning, m
  double restitution = 0.0, work = 0.0, deepest = 0.0;
  int parts = 0;

  Collision() {
    few.options.restitution = 1.0;
    few.options.friction = 0.0;
    few.options.radius = 0.006;
  }
  /// @param refine as the terrain does; else every step as it is
  void run(double v, double step, bool refine) {
    few.options.step = step;
    GrainSolver s = few.make({{0.29, 0.0, 0.3, 0.0}, {0.302 + gap, 0.0, 0.3, 0.0}});
    set_velocity(s, 0, Vec3(v, 0, 0));
    set_velocity(s, 1, Vec3(-v, 0, 0));
    s.reset_accounts();
    StepRefinement refinement(few.options);
    refinement.set_step(step);
    parts = 0;
    for (int n = 0; n * step < 0.02; ++n) {
      for (int done = 0; done < 256;) {
        if (refine) {
          EXPECT_TRUE(refinement.choose(s, done == 0).ok);
        }
        parts = std::max(parts, 1 << refinement.level());
        done += 256 >> refinement.level();
        const double dt = std::ldexp(step, -refinement.level());
        EXPECT_LT(s.step_part({dt, refinement.since(), step, done == 256}), 0);
        refinement.took(dt);
      }
      refinement.count(1 << refinement.level());
    }
    restitution = (velocity(s, 1) - velocity(s, 0)).x() / (2.0 * v);
    deepest = s.accounts().max_overlap;
    work = s.accounts().contact_work;
  }
};

/// Elastic spheres part as fast as they met [Johnson 1985, §11.4]; their deepest overlap is
/// (15/16 m* v_rel²/(E* √R*))^{2/5} with the whole E* √R* of the pair. The loss is of second order in the whole step,
/// at which the collision begins. If forces acted for each part's own dt, energy would grow (rms 8 %).
TEST(StepRefinement, collisions_above_the_stable_step_gain_no_energy_and_lose_little) {
  Collision c;
  const dem::DemOptions& o = c.few.options;
  const double step = 0.98 * dem::stable_at(o, dem::stated_overlap(o)).step;
  const double e_star = o.young_modulus / 2.0 / (1.0 - o.poisson_ratio * o.poisson_ratio);
  const double mass = dem::grain_properties(o.radius, o.density).mass, v = 9.0;
  const double hertz = std::pow(15.0 / 16.0 * 0.5 * mass * 4.0 * v * v / (e_star * std::sqrt(0.5 * o.radius)), 0.4);
  ASSERT_GT(hertz, dem::stated_overlap(o) * 2.0);
  ASSERT_LT(hertz, 2.0 * dem::kDeepestShare * o.radius);
  ASSERT_GT(step, dem::stable_at(o, hertz).step);
  double squares = 0.0, whole = 0.0, half = 0.0;
  constexpr int kPhases = 8;
  for (int phase = 0; phase < kPhases; ++phase) {
    c.gap = 5e-4 + 2.0 * v * step * phase / kPhases;
    c.run(v, step, true);
    EXPECT_GE(c.parts, 2);
    EXPECT_NEAR(c.deepest, hertz, 0.07 * hertz);
    EXPECT_LT(c.restitution, 1.01);
    EXPECT_GT(c.restitution, 0.94);
    squares += std::pow(c.restitution - 1.0, 2) / kPhases;
    c.run(v, step, false);
    whole = std::max(whole, std::abs(c.restitution - 1.0));
    c.run(v, 0.5 * step, false);
    half = std::max(half, std::abs(c.restitution - 1.0));
  }
  std::printf("restitution error: parts %.4f rms; whole step %.4f, half step %.4f largest\n", std::sqrt(squares), whole,
              half);
  EXPECT_LT(std::sqrt(squares), 0.045);
}

TEST(StepRefinement, gentle_contacts_change_nothing) {
  Collision c;
  const double step = 0.9 * dem::stable_at(c.few.options, dem::stated_overlap(c.few.options)).step;
  c.run(1.0, step, true);
  const double with = c.restitution, work = c.work;
  EXPECT_EQ(c.parts, 1);
  c.run(1.0, step, false);
  EXPECT_EQ(c.restitution, with);
  EXPECT_EQ(c.work, work);
}

TEST(StepRefinement, limits_are_where_the_parts_are_just_stable) {
  dem::DemOptions o;
  o.step = 0.9 * dem::stable_at(o, dem::stated_overlap(o)).step;
  StepRefinement r(o);
  r.set_step(o.step);
  EXPECT_NEAR(dem::stable_at(o, r.limit(0)).step, o.step, 1e-9 * o.step);
  // δ^(−1/4): (1/0.9)⁴ times the stated overlap.
  EXPECT_NEAR(r.limit(0), std::pow(0.9, -4.0) * dem::stated_overlap(o), 1e-6 * r.limit(0));
  EXPECT_TRUE(std::isinf(r.limit(1)));
  o.allow_unstable_step = true;
  StepRefinement none(o);
  none.set_step(o.step);
  EXPECT_THROW(none.limit(0), std::out_of_range);
}

const ContactMaterial kSteel{2e11, 0.3, 0.5, 0.2, 1e9, 10.0, 0.0};

/// Grains under a plate that presses harder and harder, then releases them.
class Pressed : public dem::SmallBeds {
 protected:
  Pressed() {
    options_.young_modulus = 2e6;
    options_.restitution = 0.5;
    options_.activity = false;  // sleep takes momentum, to 1e-3 of the weight's
    options_.step = 0.95 * dem::stable_at(options_, dem::stated_overlap(options_)).step;
  }
  std::unique_ptr<Terrain> terrain(int threads) {
    options_.threads = threads;
    return make_dem_terrain(options_);
  }
  PressedSurface plate_on(Terrain& terrain) const {
    const double z = terrain.gather_top_height(0.1, 0.2, -0.05, 0.05) + 1e-4;
    PressedSurface plate{testing::under_side(0.1, 0.2, -0.05, 0.05, z)};
    terrain.attach(plate.shape.mesh, kSteel, plate.state);
    return plate;
  }
  double interval() const { return 2.0 * options_.step; }
  /// Intervals of two steps each. @returns the first failure
  Outcome press(Terrain& terrain, PressedSurface& plate, double speed, int intervals) const {
    return plate.move(terrain, Vec3(0.0, 0.0, -speed), intervals, interval(), 2);
  }
};

TEST_F(Pressed, hard_contacts_are_survived_alike_for_any_threads_and_after_a_restart_and_end) {
  const auto a = terrain(1);
  a->prepare({});
  PressedSurface plate = plate_on(*a);
  const TerrainState before = a->gather_state();
  // Down by 14 mm, in two stretches: the first ends while steps are taken in parts.
  const int way = static_cast<int>(0.014 / 0.5 / interval());
  int pressed = 0;
  Outcome outcome;
  while (outcome.ok && a->gather_state().most_parts == 1 && pressed < way)
    outcome = press(*a, plate, 0.5, 1), ++pressed;
  ASSERT_TRUE(outcome.ok) << outcome.message("terrain");
  ASSERT_GT(a->gather_state().substeps_added, 0) << "pressed by " << plate.hardest << " N";
  Archive saved;
  a->save(saved);
  const auto b = terrain(2);
  b->restore(saved);
  EXPECT_EQ(hash_of(*a), hash_of(*b));
  PressedSurface other = plate;
  const int more = 120;
  outcome = press(*a, plate, 0.05, more);
  ASSERT_TRUE(outcome.ok) << outcome.message("terrain");
  ASSERT_TRUE(press(*b, other, 0.05, more).ok);
  EXPECT_EQ(hash_of(*a), hash_of(*b));
  EXPECT_GT(a->gather_state().refined_time, 0.0);
  EXPECT_GE(a->gather_state().most_parts, 2);

  // Let go: the whole step comes back and stays.
  ASSERT_TRUE(press(*a, plate, -0.2, 400).ok);
  const std::int64_t added = a->gather_state().substeps_added;
  ASSERT_TRUE(press(*a, plate, -0.2, 200).ok);
  EXPECT_EQ(a->gather_state().substeps_added, added);

  // The impulses equal the change of momentum to round-off, for any steps.
  const TerrainState after = a->gather_state();
  const double mass = 2500 * 4.0 / 3.0 * M_PI * 1e-6 * static_cast<double>(a->size());
  const Vec3 weight = mass * plate.elapsed * standard_gravity();
  const auto given = [](const TerrainState& s) -> Vec3 {
    return s.momenta.wall_impulse + s.momenta.surface_impulse + s.momenta.sleep_impulse - s.momenta.grains;
  };
  EXPECT_LT((given(after) - given(before) + weight).norm(), 1e-10 * weight.norm());
}

TEST_F(Pressed, a_contact_that_no_step_can_hold_ends_with_where_and_what_to_change) {
  const auto a = terrain(1);
  a->prepare({});
  PressedSurface plate = plate_on(*a);
  const Outcome outcome = press(*a, plate, 2.0, 100000);
  ASSERT_FALSE(outcome.ok);
  const std::string said = outcome.message("terrain");
  std::puts(said.c_str());
  for (const char* word : {"contact", "deeper than 30 % of a grain's diameter", "at (", "young_modulus", kNoStepHelps})
    EXPECT_TRUE(holds(said, word));
}

}  // namespace
}  // namespace furrow::terrain
