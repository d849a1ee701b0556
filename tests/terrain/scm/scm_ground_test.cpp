// Empirical soil under a plate against Bekker's, Wong's and Janosi's closed forms; momentum, energy, continuation,
// messages.
#include "terrain/scm/scm_ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "protocol/core/error.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/scm/scm_spec.hpp"
#include "tests/refusal.hpp"
#include "tests/saved.hpp"
#include "tests/terrain/scm/driven_surface.hpp"

namespace furrow::terrain::scm {
namespace {

using testing::DrivenSurface;

ScmOptions small_bed() {
  ScmOptions options;
  options.length = 1.0;
  options.width = 0.4;
  options.rebound_damping = 0.0;
  return options;
}

/// A plate 0.2 m long and 0.1 m wide that covers 20 × 10 cells.
DrivenSurface plate() { return {testing::box({-0.1, -0.05, 0.0}, {0.1, 0.05, 0.1}), {0.5, 0.0, 0.0}}; }

DrivenSurface plate_on(Terrain& ground, double friction = 0.8) {
  DrivenSurface tool = plate();
  tool.attach(ground, friction);
  return tool;
}
constexpr double kArea = 0.02, kWidth = 0.2 * 0.1 / 0.3;  // m², b = 2 A/P in m

double bekker(const ScmOptions& o, double b, double z) {
  return (o.bekker_k_c / b + o.bekker_k_phi) * std::pow(z, o.bekker_n);
}

TEST(ScmGround, a_plate_meets_bekkers_curve_with_the_width_of_its_patch) {
  for (const double given : {-1.0, 0.1}) {
    ScmOptions options = small_bed();
    options.patch_width = given;
    const auto ground = make_scm_ground(options);
    DrivenSurface tool = plate_on(*ground);
    const double dt = 1e-3, speed = 0.1;
    for (int i = 0; i < 100; ++i) {
      tool.move(*ground, {0.0, 0.0, -speed}, 0.0, dt);
      const double z = speed * dt * (i + 0.5);  // forces are those of the middle
      EXPECT_NEAR(tool.sums.force.z() / (kArea * bekker(options, given > 0.0 ? given : kWidth, z)), 1.0, 1e-9) << i;
      EXPECT_NEAR(tool.sums.force.head<2>().norm() / tool.sums.force.z(), 0.0, 1e-12);
      EXPECT_LT(tool.sums.transfer_force_residual, 1e-12);
      EXPECT_LT(tool.sums.transfer_moment_residual, 1e-12);
    }
    EXPECT_NEAR(ground->gather_state().floor_force, tool.sums.force.z(), 1e-9 * tool.sums.force.z());
    EXPECT_LT(std::abs(testing::residual(*ground)), 0.02 * ground->gather_state().energies.surface_work);
  }
}

TEST(ScmGround, a_plate_unloads_and_reloads_along_wongs_line_and_leaves_a_rut) {
  ScmOptions options = small_bed();
  options.bekker_k_phi = 505.8e3;
  options.bekker_n = 0.7;
  options.unloading_stiffness = 0.0;
  options.unloading_stiffness_rate = 5.03e8;
  options.patch_width = 0.1;
  const auto ground = make_scm_ground(options);
  DrivenSurface tool = plate_on(*ground);
  const double dt = 1e-3, speed = 0.1, z_u = 0.02;
  for (int i = 0; i < 200; ++i) tool.move(*ground, {0.0, 0.0, -speed}, 0.0, dt);
  tool.move(*ground, Vec3::Zero(), 0.0, dt);  // the middle of this interval is z_u
  const double p_u = bekker(options, 0.1, z_u), k_u = options.unloading_stiffness_rate * z_u;
  EXPECT_NEAR(tool.sums.force.z() / (kArea * p_u), 1.0, 1e-9);
  for (int i = 0; i < 100; ++i) {
    tool.move(*ground, {0.0, 0.0, speed}, 0.0, dt);
    const double p = p_u - k_u * speed * dt * (i + 0.5);
    EXPECT_NEAR(tool.sums.force.z() / kArea, std::max(p, 0.0), 1e-6 * p_u) << i;
  }
  const double rut = z_u - p_u / k_u;
  const HeightField field = ground->gather_height_field();
  int sunk = 0;
  for (const double height : field.height)
    if (height != 0.0) {
      EXPECT_NEAR(height, -rut, 1e-9);
      ++sunk;
    }
  EXPECT_EQ(sunk, 200);
  EXPECT_NEAR(ground->gather_mean_height(0.4, 0.6, -0.05, 0.05), -rut, 1e-9);
  EXPECT_EQ(ground->gather_top_height(0.3, 0.7, -0.1, 0.1), 0.0);
  // The loss is the work minus the returned part.
  const TerrainEnergies e = ground->gather_state().energies;
  EXPECT_EQ(e.stored(), 0.0);
  const double compaction =
      kArea * ((options.bekker_k_c / 0.1 + options.bekker_k_phi) * std::pow(z_u, 1.7) / 1.7 - 0.5 * p_u * p_u / k_u);
  EXPECT_NEAR(e.normal_damping_loss / compaction, 1.0, 0.01);
  EXPECT_LT(std::abs(testing::residual(*ground)), 0.01 * compaction);
  // The second load has no force above the rut, then follows the line, then the curve.
  for (int i = 0; i < 150; ++i) tool.move(*ground, {0.0, 0.0, -speed}, 0.0, dt);
  EXPECT_NEAR(tool.sums.force.z() / (kArea * bekker(options, 0.1, 0.025 - 0.5 * speed * dt)), 1.0, 1e-9);
}

/// The tangents of all vertices: of a rigid surface.
Mat3 stiffness(const DrivenSurface& tool) {
  Mat3 sum = Mat3::Zero();
  for (const ContactTangent& one : tool.forces.tangent) sum += one.stiffness;
  return sum;
}

TEST(ScmGround, contact_tangents_are_the_derivative_of_what_an_inclined_plate_meets_on_its_way_back) {
  ScmOptions options = small_bed();
  options.contact_tangents = true;
  const auto ground = make_scm_ground(options);
  DrivenSurface tool = plate();
  tool.turn = 0.3;
  tool.position.z() = 0.2 * std::sin(0.3);
  tool.attach(*ground, 0.0);
  const double dt = 1e-3;
  for (int i = 0; i < 400; ++i) tool.move(*ground, {0.0, 0.0, -0.1}, 0.0, dt);
  tool.move(*ground, {0.0, 0.0, 1e-3}, 0.0, dt);
  for (const Vec3& way : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(0.6, 0.0, 0.8)}) {
    tool.move(*ground, Vec3::Zero(), 0.0, dt);
    const Vec3 before = tool.sums.force, expected = -1e-7 * stiffness(tool) * way;
    tool.move(*ground, 1e-4 * way, 0.0, dt);  // 1e-7 m, and no further
    tool.move(*ground, Vec3::Zero(), 0.0, dt);
    const Vec3 change = tool.sums.force - before;
    EXPECT_GT(change.norm(), 0.01);
    EXPECT_LT((change - expected).norm(), 1e-5 * change.norm()) << way.transpose();
  }
}

TEST(ScmGround, the_tangent_of_shear_begins_at_tau_max_over_K_and_ends_at_nothing) {
  ScmOptions options = small_bed();
  options.contact_tangents = true;
  options.janosi_k = 1.5e-3;
  const auto ground = make_scm_ground(options);
  DrivenSurface tool = plate_on(*ground, 10.0);
  for (int i = 0; i < 100; ++i) tool.move(*ground, {0.0, 0.0, -0.1}, 0.0, 1e-3);
  tool.move(*ground, Vec3::Zero(), 0.0, 1e-3);
  const double begin = stiffness(tool)(0, 0);
  tool.move(*ground, {1e-4, 0.0, 0.0}, 0.0, 1e-3);
  const double first = -tool.sums.force.x() / 0.5e-7;  // the force is that of the middle
  EXPECT_NEAR(first / begin, 1.0, 1e-4);
  for (int i = 0; i < 100; ++i) tool.move(*ground, {0.1, 0.0, 0.0}, 0.0, 1e-3);
  EXPECT_LT(stiffness(tool)(0, 0), 1e-2 * begin);
}

TEST(ScmGround, a_plate_that_slides_meets_janosis_curve_under_mohr_coulombs_limit) {
  ScmOptions options = small_bed();
  options.janosi_k = 1.5e-3;  // fully mobilized before the plate's edge reaches other nodes
  const auto ground = make_scm_ground(options);
  DrivenSurface tool = plate_on(*ground, 10.0);
  for (int i = 0; i < 100; ++i) tool.move(*ground, {0.0, 0.0, -0.1}, 0.0, 1e-3);
  const double dt = 1e-3, speed = 0.045, p = bekker(options, kWidth, 0.01);
  const double limit = kArea * (options.mohr_cohesion + p * std::tan(options.mohr_friction_angle * M_PI / 180.0));
  const Vec3 way(0.6, -0.8, 0.0);
  for (int i = 0; i < 100; ++i) {
    tool.move(*ground, speed * way, 0.0, dt);
    const double share = speed * dt / options.janosi_k;  // mean of 1 − exp(−j/K) over the interval
    const double expected = 1.0 - std::exp(-share * i) * -std::expm1(-share) / share;
    EXPECT_NEAR((tool.sums.tangential / -limit - expected * way).norm(), 0.0, 1e-6) << i;
    EXPECT_NEAR(tool.sums.normal.z() / (kArea * p), 1.0, 1e-9);
  }
  EXPECT_LT(std::abs(testing::residual(*ground)), 0.01 * ground->gather_state().energies.surface_work);
}

TEST(ScmGround, gives_the_momentum_that_it_takes_and_hands_out_no_energy) {
  const auto ground = make_scm_ground(small_bed());
  DrivenSurface tool{testing::wheel(0.15, 0.1, 60, 4), {0.25, 0.03, 0.151}};
  tool.attach(*ground, 0.8);
  Vec3 received = Vec3::Zero();
  double lost = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double down = 0.1 * std::cos(0.03 * i);
    tool.move(*ground, {0.5, 0.05 * std::sin(0.01 * i), -down}, 4.0, 1e-3, 2);
    Vec3 nodal = Vec3::Zero();
    for (const Vec3& f : tool.forces.force) nodal += f;
    EXPECT_LT((nodal - tool.sums.force).norm(), 1e-9 * (1.0 + nodal.norm()));
    received += 1e-3 * nodal;
    EXPECT_GE(tool.sums.normal.z(), 0.0);
    EXPECT_GE(ground->gather_state().energies.normal_damping_loss, lost - 1e-9);
    lost = ground->gather_state().energies.normal_damping_loss;
  }
  EXPECT_GT(received.norm(), 1.0);
  EXPECT_LT((received + ground->gather_state().momenta.surface_impulse).norm(), 1e-10 * received.norm());
}

TEST(ScmGround, continues_bit_for_bit_from_what_it_saved) {
  const auto ground = make_scm_ground(small_bed()), again = make_scm_ground(small_bed());
  DrivenSurface tool{testing::wheel(0.15, 0.1, 60, 4), {0.3, 0.0, 0.151}};
  tool.attach(*ground, 0.8);
  const auto drive = [](Terrain& on, DrivenSurface& with, int from, int to) {
    for (int i = from; i < to; ++i) with.move(on, {0.5, 0.02, -0.1 * std::cos(0.03 * i)}, 4.5, 1e-3, 2);
  };
  drive(*ground, tool, 0, 150);
  again->restore(testing::saved(*ground));
  DrivenSurface other = tool;
  drive(*ground, tool, 150, 250);
  drive(*again, other, 150, 250);
  EXPECT_EQ(tool.sums.force, other.sums.force);
  EXPECT_EQ(tool.forces.force, other.forces.force);
  EXPECT_EQ(ground->gather_height_field().height, again->gather_height_field().height);
  const TerrainEnergies a = ground->gather_state().energies, b = again->gather_state().energies;
  EXPECT_EQ(a.losses(), b.losses());
  EXPECT_EQ(a.stored(), b.stored());
}

/// Heights before the run, straight from (0, `first`) to (1, `last`).
GroundShape ramp(double first, double last) { return {{{0.0, first}, {1.0, last}}, nullptr}; }

TEST(ScmGround, level_heights_of_a_file_give_level_soil_moved_up_by_them) {
  const double up = 0.37;
  ScmOptions raised = small_bed();
  raised.shape = {{}, std::make_shared<HeightMap>(HeightMap{{0.0, 1.0}, {-1.0, 1.0}, {up, up, up, up}})};
  for (const ScmOptions& options : {raised, [&] {
                                      ScmOptions o = small_bed();
                                      o.shape = ramp(up, up);
                                      return o;
                                    }()}) {
    const auto level = make_scm_ground(small_bed()), high = make_scm_ground(options);
    DrivenSurface low{testing::wheel(0.15, 0.1, 60, 4), {0.3, 0.0, 0.151}}, tool = low;
    tool.position.z() += up;
    low.attach(*level, 0.8), tool.attach(*high, 0.8);
    EXPECT_EQ(high->gather_top_height(0.1, 0.5, -0.1, 0.1), up);
    double largest = 0.0;  // N
    for (int i = 0; i < 150; ++i) {
      const Vec3 velocity(0.5, 0.02, -0.1 * std::cos(0.03 * i));
      low.move(*level, velocity, 4.5, 1e-3), tool.move(*high, velocity, 4.5, 1e-3);
      largest = std::max(largest, low.sums.force.norm());
      ASSERT_LT((low.sums.force - tool.sums.force).norm(), 1e-9 * (1.0 + low.sums.force.norm())) << i;
    }
    EXPECT_GT(largest, 10.0);
    EXPECT_NEAR(high->gather_mean_height(0.3, 0.4, -0.03, 0.03), up + level->gather_mean_height(0.3, 0.4, -0.03, 0.03),
                1e-12);
    EXPECT_NEAR(high->gather_state().energies.losses(), level->gather_state().energies.losses(), 1e-9);
  }
}

/// p A (−tan β, 0, 1) of a smooth plate that lies on a ramp and sinks straight down.
TEST(ScmGround, a_smooth_plate_that_lies_on_a_ramp_meets_bekkers_pressure_along_its_normal) {
  ScmOptions options = small_bed();
  options.patch_width = 0.1;
  const double slope = 0.2;
  options.shape = ramp(-0.1, 0.1);
  const auto ground = make_scm_ground(options);
  DrivenSurface tool = plate();
  tool.turn = -std::atan(slope);
  tool.attach(*ground, 0.0);
  const double dt = 1e-3, speed = 0.1;
  for (int i = 0; i < 100; ++i) {
    tool.move(*ground, {0.0, 0.0, -speed}, 0.0, dt);
    const double area = 1e-4 * static_cast<double>(ground->gather_state().contacts), z = speed * dt * (i + 0.5);
    EXPECT_NEAR(area, kArea * std::cos(tool.turn), 1.1e-3);
    const Vec3 expected = area * bekker(options, 0.1, z) * Vec3(-slope, 0.0, 1.0);
    EXPECT_LT((tool.sums.force - expected).norm(), 1e-9 * expected.norm()) << i;
  }
  EXPECT_LT(std::abs(testing::residual(*ground)), 0.02 * ground->gather_state().energies.surface_work);
}

TEST(ScmGround, accounts_close_under_a_wheel_that_climbs_a_ramp) {
  ScmOptions options = small_bed();
  options.shape = ramp(0.0, 0.2);
  const auto ground = make_scm_ground(options);
  const double slope = 0.2, sunk = 0.01, c = std::sqrt(1.0 + slope * slope);
  DrivenSurface tool{testing::wheel(0.15, 0.1, 60, 4), {0.25, 0.0, 0.05 + 0.15 * c}};
  tool.attach(*ground, 0.8);
  for (int i = 0; i < 100; ++i) tool.move(*ground, {0.5, 0.0, 0.5 * slope - sunk / 0.1}, 3.5, 1e-3);
  for (int i = 0; i < 700; ++i) tool.move(*ground, {0.5, 0.0, 0.5 * slope}, 3.5, 1e-3);
  const TerrainEnergies e = ground->gather_state().energies;
  EXPECT_GT(e.losses(), 10.0);
  EXPECT_LT(std::abs(testing::residual(*ground)), 0.01 * e.losses());
  // The rut runs along the ramp.
  const double early = ground->gather_mean_height(0.395, 0.405, -0.02, 0.02),
               late = ground->gather_mean_height(0.495, 0.505, -0.02, 0.02);
  EXPECT_NEAR(late - early, 0.1 * slope, 1e-3);
  EXPECT_LT(early, 0.4 * slope - 0.5 * sunk);
}

/// What a scenario may say is asked of the program by tests/system/bad_input.py.
TEST(ScmGround, says_what_is_wrong_with_its_options) {
  ScmOptions options = small_bed();
  options.scenario = "mine.json";
  options.janosi_k = -1.0;
  EXPECT_EQ(refusal(ExitCode::bad_input, [&] { make_scm_ground(options); }),
            "mine.json: key 'terrain.janosi_k': is -1 m, expected a number, above 0 up to 10 m");
  options = small_bed();
  options.rebound_damping = NAN;
  expect_refused(ExitCode::bad_input, {"rebound_damping"}, [&] { make_scm_ground(options); });
}

TEST(ScmGround, refuses_a_grid_too_coarse_for_a_surface_and_a_soil_that_cannot_bear_one_of_its_width) {
  const auto refused = [](const ScmOptions& options) -> std::string {
    return refusal(ExitCode::bad_input, [&] { check_scm_width(options, 0.1); });
  };
  ScmOptions options = small_bed();
  options.grid_spacing = 0.025;
  EXPECT_EQ(refused(options), "");
  options.grid_spacing = 0.03;
  EXPECT_EQ(
      refused(options),
      "scenario: key 'terrain.grid_spacing': is 0.03 m, expected at most 0.025 m, a quarter of the tire's width (a "
      "tenth is good)");
  options.grid_spacing = 0.01;
  options.bekker_k_phi = 291e3;
  options.bekker_k_c = -29e3;
  EXPECT_EQ(refused(options), "");
  options.bekker_k_c = -30e3;
  EXPECT_EQ(
      refused(options),
      "scenario: key 'terrain.bekker_k_c': is -30000, expected above -2.91e+04: k_c/b + k_phi has to be above 0 for "
      "a b of the tire's width, 0.1 m");
}

TEST(ScmGround, stops_when_a_tire_leaves_it_and_refuses_one_that_starts_in_it) {
  const auto ground = make_scm_ground(small_bed());
  DrivenSurface tool = plate_on(*ground);
  tool.position = Vec3(0.95, 0.0, 0.0);
  const SurfaceState state = tool.state({0.0, 0.0, -1.0});
  const Outcome outcome = ground->advance({&state, 1}, 1e-3, 1, {&tool.forces, 1}, {&tool.sums, 1});
  EXPECT_FALSE(outcome.ok);
  EXPECT_TRUE(holds(outcome.message("terrain"), "was left by a tire"));
  tool.position = Vec3(0.5, 0.0, -0.01);
  EXPECT_THROW(tool.attach(*make_scm_ground(small_bed()), 0.8), Error);
}

/// LETE sand with k_c in kN/m^(n+1); the k_c of dry sand, 990 N/m^(n+1) beside 1.53e6, is small and right.
TEST(ScmGround, a_cohesive_modulus_in_kilonewtons_is_told) {
  ScmOptions options = small_bed();
  EXPECT_TRUE(make_scm_spec(options)->describe().remarks.empty());
  options.bekker_k_c = 102;
  const auto told = make_scm_spec(options)->describe().remarks;
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].first, "bekker_k_c");
  EXPECT_EQ(told[0].second, "is 102 N/m^(n+1), less than 0.0001 m × bekker_k_phi: it changes nothing, or is it in kN?");
  options.bekker_k_c = 990, options.bekker_k_phi = 1528430;
  EXPECT_TRUE(make_scm_spec(options)->describe().remarks.empty());
  options.bekker_k_c = 0.0;
  EXPECT_TRUE(make_scm_spec(options)->describe().remarks.empty());
}

}  // namespace
}  // namespace furrow::terrain::scm
