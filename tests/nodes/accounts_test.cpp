// The accounts of whole co-simulations close, better with a smaller step, and reveal a wrong entry.
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "nodes/output/accounts.hpp"
#include "nodes/output/accounts_json.hpp"
#include "nodes/ranks/run_node.hpp"
#include "tests/nodes/in_process_run.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/nodes/small_scenarios.hpp"
#include "tests/protocol/fields_of.hpp"

namespace furrow::output {
namespace {

using testing::OneWheel;

template <class S>
void expect_whole_list() {
  EXPECT_EQ(testing::names_of<S>().size(), testing::member_count<S>());
}

TEST(Accounts, no_list_forgets_a_member_of_its_struct) {
  expect_whole_list<rigs::RigAccounts>();
  expect_whole_list<TireAccount>();
  expect_whole_list<Books>();
  expect_whole_list<WorkAccount>();
  expect_whole_list<StoredAccount>();
  expect_whole_list<LostAccount>();
}

/// The accounts of the rig's node after `steps` steps.
Accounts accounts_after(const scenario::Scenario& scenario, std::int64_t steps) {
  testing::InProcessRun run(scenario);
  run.steps(0, steps);
  run.synchronize(steps);
  const std::vector<Archive> saved = run.save();
  Accounts accounts(std::vector<MassProperties>(scenario.tires.size()), scenario.run.step);
  accounts.restore(saved.front());
  return accounts;
}

OneWheel flexible_tire_on_plane() {
  OneWheel scenario = testing::rigid_wheel_on_plane();
  scenario.wheel_tire.rigid = false;
  scenario.wheel_tire.elements_circumference = 30;
  scenario.wheel_tire.elements_width = 6;
  scenario.wheel_rig.touchdown_time = 0.1;
  terrain::GroundOptions ground;
  ground.ground_stiffness = 5e7;
  ground.ground_shear_stiffness = 2e7;
  ground.ground_damping = 1e4;
  scenario.terrain = terrain::make_ground_spec(ground);
  return scenario;
}

/// Accounts after a simulated time with the step H.
Accounts rolled(OneWheel scenario, double step, double time) {
  scenario.run.step = step;
  return accounts_after(scenario.made(), std::llround(time / step));
}

/// With prompt forces, only the added mass' impulse is under way.
void expect_momentum_closes(const Accounts& accounts, bool prompt = false) {
  const MomentumAccount m = accounts.momentum();
  EXPECT_TRUE(m.closes()) << "residual " << m.residual().transpose() << ", surface "
                          << m.surface_difference().transpose() << ", spindle " << m.spindle_difference().transpose()
                          << " N s of " << m.largest();
  EXPECT_GT(m.surface_of_tires.norm(), 1.0) << "the wheel never touched the ground";
  if (!prompt) {
    EXPECT_GT(m.under_way.norm(), 1e-5 * m.largest()) << "what is under way must matter";
  }
}

TEST(Accounts, momentum_closes_on_hard_ground) {
  expect_momentum_closes(rolled(testing::rigid_wheel_on_plane(), 1e-4, 0.3), true);
  expect_momentum_closes(rolled(flexible_tire_on_plane(), 1e-4, 0.15));
}

TEST(Accounts, momentum_closes_on_grains) {
  expect_momentum_closes(rolled(testing::rigid_wheel_on_grains(), 1e-4, 0.2));
}

TEST(Accounts, energy_closes_with_the_step_on_hard_ground) {
  const EnergyAccount coarse = rolled(flexible_tire_on_plane(), 1e-4, 0.15).energy(),
                      fine = rolled(flexible_tire_on_plane(), 5e-5, 0.15).energy();
  EXPECT_GT(fine.work.drive, 10.0);
  EXPECT_GT(fine.lost.tire_viscous, 1.0);
  for (const EnergyAccount* a : {&coarse, &fine}) {
    EXPECT_TRUE(a->closes()) << a->residual() << " J of " << a->turnover();
    EXPECT_NEAR(a->residual(), a->terrain_residual + a->tire_residual + a->rig_residual, 1e-9 * a->turnover());
  }
  EXPECT_LT(std::abs(fine.tire_residual), 0.6 * std::abs(coarse.tire_residual) + 1e-9 * fine.turnover());
  EXPECT_LT(std::abs(fine.rig_residual), 0.6 * std::abs(coarse.rig_residual) + 1e-9 * fine.turnover());
  EXPECT_LT(std::abs(fine.lost.surface_lag), 0.7 * std::abs(coarse.lost.surface_lag));
  std::printf("residuals of terrain, tire, rig: %.3g, %.3g, %.3g and %.3g, %.3g, %.3g J of %.4g J\n",
              coarse.terrain_residual, coarse.tire_residual, coarse.rig_residual, fine.terrain_residual,
              fine.tire_residual, fine.rig_residual, fine.turnover());
}

/// Energy of the HMMWV on rigid wheels that steers into a turn at 11 m/s on hard ground.
EnergyAccount turned(double step, double time) {
  using nlohmann::json;
  const json turn = {{"rig",
                      {{"type", "vehicle"},
                       {"vehicle", "hmmwv.json"},
                       {"start_speed", 11},
                       {"driver", {{"speed", {{"target", 11}}}, {"inputs", {{"steering", {{0, 0}, {0.4, 0.3}}}}}}}}},
                     {"tire", {{"rigid", true}, {"elements_circumference", 60}, {"elements_width", 8}}},
                     {"terrain",
                      {{"engine", "rigid"},
                       {"friction", 0.9},
                       {"friction_velocity_scale", 50},
                       {"ground_stiffness", 6.4e7},
                       {"ground_shear_stiffness", 1.6e7},
                       {"ground_damping", 1e4}}},
                     {"run", {{"step", step}, {"end", time}, {"average_from", 0.0}}},
                     {"output", {{"frame_interval", 0}}}};
  return accounts_after(testing::ScenarioFile(turn.dump()).load(), std::llround(time / step)).energy();
}

/// The shear of the ground under tires that slip sideways is stepped implicitly. The loss of such a step is recorded.
TEST(Accounts, energy_closes_in_a_turn_on_rigid_wheels) {
  const EnergyAccount coarse = turned(2e-4, 0.7), fine = turned(1e-4, 0.7);
  EXPECT_GT(coarse.lost.sliding + coarse.lost.tangential_damping + coarse.lost.opening, 0.1 * coarse.turnover());
  EXPECT_LT(std::abs(coarse.residual()), 1e-4 * coarse.turnover());
  EXPECT_LT(std::abs(fine.residual()), 0.35 * std::abs(coarse.residual()));
  for (const EnergyAccount* a : {&coarse, &fine})
    std::printf("residuals of terrain, tires, rig: %.4g, %.4g, %.4g J of %.4g J\n", a->terrain_residual,
                a->tire_residual, a->rig_residual, a->turnover());
}

TEST(Accounts, energy_closes_on_grains) {
  const EnergyAccount a = rolled(testing::rigid_wheel_on_grains(), 1e-4, 0.2).energy();
  EXPECT_TRUE(a.closes()) << a.residual() << " J of " << a.turnover() << ", terrain " << a.terrain_residual << ", tire "
                          << a.tire_residual << ", rig " << a.rig_residual;
}

/// An error of 10 % in a single entry is noticed if the entry is at least a third of the turnover.
TEST(Accounts, an_entry_that_is_wrong_is_noticed) {
  const Accounts accounts = rolled(flexible_tire_on_plane(), 1e-4, 0.15);
  const Books &start = accounts.start(), &now = accounts.now();
  ASSERT_TRUE(energy_account(start, now).closes());
  ASSERT_TRUE(momentum_account(start, now).closes());
  Books wrong = now;
  wrong.rig.damper_loss += 0.1 * 0.35 * accounts.energy().turnover();
  EXPECT_FALSE(energy_account(start, wrong).closes());
  wrong = now;
  wrong.tires[0].rim_work *= 1.1;  // also appears as a lag of the rim, so only in the tire's own residual
  EXPECT_GT(std::abs(energy_account(start, wrong).tire_residual), 10.0 * std::abs(accounts.energy().tire_residual));
  wrong = now;
  wrong.rig.guide_impulse *= 1.0 + 1e-4;
  EXPECT_FALSE(momentum_account(start, wrong).closes());
  wrong = now;
  wrong.tires[0].sent_by_terrain.setZero();  // one step forgotten
  EXPECT_FALSE(momentum_account(start, wrong).closes());
  wrong = now;
  wrong.tires[0].sent_to_rig.setZero();
  EXPECT_FALSE(momentum_account(start, wrong).closes());
  wrong = now;
  wrong.tires[0].model.momentum.z() = NAN;
  EXPECT_FALSE(momentum_account(start, wrong).closes());
}

TEST(Accounts, restored_accounts_are_the_saved_ones) {
  const scenario::Scenario scenario = testing::rigid_wheel_on_plane().made();
  testing::InProcessRun whole(scenario), resumed(scenario);
  whole.steps(0, 100);
  resumed.restore(whole.save());
  whole.steps(100, 200), resumed.steps(100, 200);
  Accounts a({MassProperties()}, 1e-4), b = a;
  const std::vector<Archive> one = whole.save(), other = resumed.save();
  a.restore(one.front()), b.restore(other.front());
  EXPECT_EQ(a.energy().residual(), b.energy().residual());
  EXPECT_EQ(a.momentum().residual(), b.momentum().residual());
  EXPECT_GT(a.energy().turnover(), 0.0);
  std::vector<double> line(a.line().begin(), a.line().end());
  Table table = Accounts::empty_table();
  for (const double time : {0.0, 0.01}) {
    line.front() = time;
    table.kept.add(line);
  }
  const nlohmann::ordered_json json = accounts_json(a, table, 0.0);
  EXPECT_EQ(json["energy"]["residual"], a.energy().residual());
  EXPECT_EQ(json["energy"]["power"]["drive_work"], 0.0);
  EXPECT_EQ(json["momentum"]["residual"].size(), 3U);
}

}  // namespace
}  // namespace furrow::output
