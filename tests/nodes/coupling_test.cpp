// Whole co-simulations in one process: the interfaces conserve momentum, and a restored run continues.
#include <gtest/gtest.h>

#include <filesystem>

#include "nodes/output/series_builder.hpp"
#include "nodes/ranks/run_node.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/constants.hpp"
#include "tests/nodes/in_process_run.hpp"
#include "tests/nodes/small_scenarios.hpp"

namespace furrow {
namespace {

using testing::InProcessRun;
using testing::OneWheel;
using testing::rigid_wheel_on_grains;
using testing::rigid_wheel_on_plane;

void expect_same_bits_after_restore(const scenario::Scenario& scenario, std::int64_t half, std::int64_t end) {
  testing::InProcessRun whole(scenario), resumed(scenario);
  whole.steps(0, half);
  resumed.restore(whole.save());
  whole.steps(half, end), resumed.steps(half, end);
  EXPECT_EQ(whole.hashes(), resumed.hashes());
}

TEST(Coupling, restored_nodes_continue_bit_for_bit_on_rigid_ground) {
  expect_same_bits_after_restore(rigid_wheel_on_plane().made(), 150, 300);
}

TEST(Coupling, restored_nodes_continue_bit_for_bit_on_grains) {
  expect_same_bits_after_restore(rigid_wheel_on_grains().made(), 100, 200);
}

TEST(Coupling, restored_flexible_tire_continues_bit_for_bit) {
  OneWheel scenario = rigid_wheel_on_plane();
  scenario.wheel_tire.rigid = false;
  scenario.wheel_tire.elements_circumference = 30;
  expect_same_bits_after_restore(scenario.made(), 60, 120);
}

/// The present series of a wheel in the rig's node; means are sums since the last line.
output::SeriesBuilder series_now(const testing::InProcessRun& run, int wheel = 0) {
  const Archive rig = run.save().front();
  output::SeriesBuilder builder(0.4673, 0.0, 1e-4);
  Archive::Scope scope(rig, "wheel" + std::to_string(wheel) + "/");
  builder.restore(rig);
  return builder;
}

std::vector<std::uint64_t> hashes_after(const scenario::Scenario& scenario, std::int64_t steps, int threads = 0) {
  ranks::RunContext context;
  if (threads > 0) context.threads = threads;
  testing::InProcessRun run(scenario, context);
  run.steps(0, steps);
  return run.hashes();
}

TEST(Coupling, momentum_received_equals_momentum_sent_one_interval_before) {
  testing::InProcessRun run(rigid_wheel_on_grains().made());
  run.steps(0, 1500);
  run.synchronize(1500);
  const output::SeriesBuilder builder = series_now(run);
  const Vec3 sent = builder.impulse_sent_arrived(), received = builder.now().impulse_received;
  EXPECT_GT(builder.impulse_sent_abs(), 0.0) << "the wheel never touched the grains";
  EXPECT_LE((sent - received).norm(), 1e-12 * builder.impulse_sent_abs());
  EXPECT_LE(builder.now().transfer_force_residual, 1e-12);
  EXPECT_LE(builder.now().transfer_moment_residual, 1e-12);
}

OneWheel flexible_tire_on_grains_with_tangents() {
  OneWheel scenario = rigid_wheel_on_grains();
  scenario.wheel_rig.carrier_mass = 100.0;
  scenario.wheel_tire.rigid = false;
  scenario.wheel_tire.elements_circumference = 30;
  scenario.wheel_tire.contact_tangent = true;
  scenario.terrain_substeps = 2;
  scenario.run.step = 2e-4;
  return scenario;
}

TEST(Coupling, contact_tangents_continue_bit_for_bit_for_any_number_of_threads) {
  const scenario::Scenario scenario = flexible_tire_on_grains_with_tangents().made();
  expect_same_bits_after_restore(scenario, 250, 350);
  EXPECT_EQ(hashes_after(scenario, 350, 1), hashes_after(scenario, 350, 2));
}

/// Σ impulses on the tire − Σ impulses by the grains = the ledger's impulse.
TEST(Coupling, the_ledger_holds_the_difference_of_the_impulses) {
  const scenario::Scenario scenario = flexible_tire_on_grains_with_tangents().made();
  testing::InProcessRun run(scenario);
  run.steps(0, 600);
  run.synchronize(600);
  const auto saved = run.save();
  const output::SeriesBuilder builder = series_now(run);
  Vec3 ahead = Vec3::Zero();
  const auto& owed = saved[1].get<double>("ledger/owed");
  for (std::size_t i = 0; i < owed.size(); i += 3) ahead += Vec3(owed[i], owed[i + 1], owed[i + 2]);
  const Vec3 difference = builder.now().impulse_received - builder.impulse_sent_arrived();
  EXPECT_GT(builder.impulse_sent_abs(), 10.0) << "the wheel never touched the grains";
  EXPECT_LE((difference - ahead).norm(), 1e-12 * builder.impulse_sent_abs());
  EXPECT_GT(ahead.norm(), 0.0);
  EXPECT_LT(saved[1].get_double("ledger/largest"), 0.05 * builder.impulse_sent_abs());
}

/// Added mass: a lagged wrench with the tire's own inertia would be unstable from a ratio of one on.
TEST(Coupling, spin_up_and_drop_with_a_tire_three_times_as_heavy_as_its_rim) {
  for (const bool rigid : {true, false}) {
    OneWheel scenario = rigid_wheel_on_plane();
    scenario.wheel_tire.rigid = rigid;
    scenario.wheel_tire.elements_circumference = 30;
    const MassProperties tire = tire::make_tire(scenario.wheel_tire)->mass_properties();
    rigs::DrawbarRigOptions& rig = scenario.wheel_rig;
    rig.slip = 1.0;
    rig.ramp = 0.01;
    rig.touchdown_damping = 0.0;
    rig.carrier_mass = 1e-3;
    rig.rim_mass = tire.mass / 3.0;
    rig.rim_spin_inertia = tire.inertia(1, 1) / 3.0;
    rig.rim_diametral_inertia = tire.inertia(0, 0) / 3.0;
    testing::InProcessRun run(scenario.made());
    run.steps(0, 100);
    run.synchronize(100);
    const output::WheelRow row = series_now(run).now();
    const double mass = rig.carrier_mass + rig.rim_mass + tire.mass, spin = rig.angular_speed;
    const double tolerance = rigid ? 1e-9 : 0.2;  // the flexible tire also winds up and swings
    EXPECT_EQ(row.force.norm(), 0.0) << "it must not have landed";
    EXPECT_NEAR(row.vertical_momentum / (-mass * kStandardGravity * row.time), 1.0, tolerance) << "rigid: " << rigid;
    EXPECT_NEAR(row.spindle_work / (0.5 * 4.0 / 3.0 * tire.inertia(1, 1) * spin * spin), 1.0, tolerance)
        << "rigid: " << rigid;
  }
}

TEST(Coupling, one_thread_and_two_threads_give_the_same_bits) {
  const scenario::Scenario scenario = rigid_wheel_on_grains().made();
  EXPECT_EQ(hashes_after(scenario, 200, 1), hashes_after(scenario, 200, 2));
}

TEST(Coupling, a_level_profile_is_the_plane_bit_for_bit) {
  testing::OneWheel level = testing::rigid_wheel_on_plane();
  terrain::GroundOptions ground;
  ground.profile = {{-1.0, 0.0}, {1.2, 0.0}, {3.0, 0.0}};
  level.terrain = terrain::make_ground_spec(ground);
  testing::InProcessRun on_plane(testing::rigid_wheel_on_plane().made()), on_profile(level.made());
  on_plane.steps(0, 1000), on_profile.steps(0, 1000);
  EXPECT_EQ(on_plane.hashes(), on_profile.hashes());
}

TEST(Coupling, another_seed_gives_another_state) {
  scenario::Scenario other = rigid_wheel_on_grains().made();
  other.run.seed = 2;
  EXPECT_NE(hashes_after(rigid_wheel_on_grains().made(), 10), hashes_after(other, 10));
}

/// z impulse that each wheel's tire has sent for up to now, N s.
std::vector<double> vertical_impulses(const testing::InProcessRun& run, int wheels) {
  std::vector<double> impulses;
  for (int k = 0; k < wheels; ++k) impulses.push_back(series_now(run, k).now().impulse_sent.z());
  return impulses;
}

TEST(Coupling, each_of_four_wheels_on_one_bed_carries_its_own_weight) {
  const scenario::Scenario scenario = scenario::load_scenario(
      std::filesystem::path(FURROW_SOURCE_FOLDER) / "rigs" / "four_wheels.json",
      {{"terrain.radius", "0.03"}, {"terrain.layers", "3"}, {"terrain.cache", "false"}, {"run.step", "2e-4"}});
  testing::InProcessRun run(scenario);
  run.steps(0, 4500);
  const auto before = vertical_impulses(run, 4);
  run.steps(4500, 6000);
  const auto after = vertical_impulses(run, 4);
  const std::vector<rigs::WheelDescription> wheels = scenario::describe_rig(scenario).wheels;
  for (std::size_t k = 0; k < 4; ++k) {
    const double tire = 4.811, weight = kStandardGravity * (wheels[k].carried_mass + tire);
    EXPECT_NEAR((after[k] - before[k]) / 0.3, weight, 0.005 * weight) << "wheel " << k;
  }
}

TEST(Coupling, a_mismatch_of_digests_stops_every_node) {
  auto transports = make_in_process_transports(1);
  std::vector<std::thread> threads;
  std::vector<std::string> texts(transports.size());
  for (std::size_t i = 0; i < transports.size(); ++i)
    threads.emplace_back([&, i] {
      scenario::Scenario scenario = rigid_wheel_on_plane().made();
      if (i == 1) scenario.digest = "other";
      try {
        ranks::run_node(scenario, *transports[i], {});
      } catch (const std::exception& error) {
        texts[i] = error.what();
      }
    });
  for (auto& thread : threads) thread.join();
  for (const std::string& text : texts) EXPECT_NE(text, "");
}

}  // namespace
}  // namespace furrow
