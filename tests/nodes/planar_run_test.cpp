// Whole co-simulations of a planar tire with the contact, the disc and the integrators of its source.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "nodes/output/accounts.hpp"
#include "protocol/core/constants.hpp"
#include "tests/nodes/in_process_run.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using nlohmann::json;

/// A quarter car on a coarse planar tire, as a scenario on disk beside its tire file.
class PlanarRun {
 public:
  PlanarRun(const json& keys, const json& terrain, double step = 1e-4) {
    json tire = json::parse(
        std::ifstream(std::filesystem::path(FURROW_SOURCE_FOLDER) / "tire" / "data" / "aligator_planar.json"));
    tire.update({{"elements_circumference", 36}, {"elements_radial", 4}, {"contact_law", "penalty"}});
    tire.update(keys);
    std::ofstream(folder_.path() / "tire.json") << tire;
    scenario_ = {{"rig",
                  {{"type", "quarter_car"},
                   {"speed", 2.0},
                   {"ramp", 0.1},
                   {"start", 0.0},
                   {"body_mass", 1290},
                   {"unsprung_mass", 1},
                   {"suspension_stiffness", 115e3},
                   {"suspension_damping", 7.5e3}}},
                 {"tire", {{"file", (folder_.path() / "tire.json").string()}}},
                 {"terrain", {{"engine", "rigid"}}},
                 {"run", {{"step", step}, {"end", 1.0}, {"average_from", 0.5}}},
                 {"output", {{"frame_interval", 0}}}};
    scenario_["terrain"].update(terrain);
  }
  scenario::Scenario load() const { return testing::ScenarioFile(scenario_.dump()).load(); }
  std::string complaint() const { return testing::ScenarioFile(scenario_.dump()).complaint(); }

 private:
  testing::TemporaryFolder folder_;
  json scenario_;
};

const json kCurb = {{"profile", {{0.5, 0.0}, {0.5, 0.03}}}};

/// A disc of half the mass, with damping; the other half stays on the rim. It needs shorter steps.
const json kElastic = {
    {"disc_in_run", "elastic"},
    {"disc", {{"density", 370}, {"young_modulus", 1e8}, {"poisson_ratio", 0.3}, {"viscosity", 1e3}}},
    {"rim", {{"mass", 75}, {"spin_inertia", 2.42}, {"diametral_inertia", 1.21}, {"carrier_mass", 1350}}}};

TEST(PlanarRun, momentum_and_energy_close_over_a_curb) {
  for (const json& keys : {json::object(), json{{"integrator", "runge_kutta_4"}}, kElastic}) {
    const double step = keys == kElastic ? 2e-5 : 1e-4;
    const scenario::Scenario s = PlanarRun(keys, kCurb, step).load();
    EXPECT_TRUE(s.prompt(0));
    testing::InProcessRun run(s);
    const std::int64_t steps = std::llround(0.4 / step);
    run.steps(0, steps);
    run.synchronize(steps);
    output::Accounts accounts({MassProperties()}, s.run.step);
    accounts.restore(run.save().front());
    const output::MomentumAccount m = accounts.momentum();
    EXPECT_TRUE(m.closes()) << m.residual().transpose() << " N s of " << m.largest();
    const output::EnergyAccount e = accounts.energy();
    EXPECT_LT(std::abs(e.residual()), 3e-3 * e.turnover())
        << keys << e.terrain_residual << " " << e.tire_residual << " " << e.rig_residual;
    EXPECT_GT(e.lost.sliding, 0.0);
    EXPECT_GT(m.surface_of_tires.norm(), 1e3);
  }
}

/// Impulse on the tire so far, upwards, N s.
double impulse(testing::InProcessRun& run, const scenario::Scenario& s, std::int64_t step) {
  run.synchronize(step);
  output::Accounts accounts({MassProperties()}, s.run.step);
  accounts.restore(run.save().front());
  return accounts.momentum().surface_of_tires.z();
}

TEST(PlanarRun, a_wheel_that_rolls_level_carries_its_weight) {
  const scenario::Scenario s = PlanarRun(json::object(), {{"profile", {{-1.0, 0.1}, {9.0, 0.1}}}}).load();
  const double weight = (s.tires[0]->describe().mass.mass + s.tires[0]->rim().mass + 1290.0 + 1.0) * kStandardGravity;
  double sums[2];
  for (const int k : {0, 1}) {
    testing::InProcessRun run(s);
    const std::int64_t steps = k == 0 ? 8000 : 10000;
    run.steps(0, steps);
    sums[k] = impulse(run, s, steps);
  }
  EXPECT_NEAR((sums[1] - sums[0]) / (2000 * s.run.step), weight, 0.01 * weight);
}

TEST(PlanarRun, restored_nodes_continue_bit_for_bit) {
  json keys = kElastic;
  keys["integrator"] = "runge_kutta_4";
  const scenario::Scenario s = PlanarRun(keys, kCurb, 2e-5).load();
  testing::InProcessRun whole(s), resumed(s);
  whole.steps(0, 2000);
  resumed.restore(whole.save());
  whole.steps(2000, 2500), resumed.steps(2000, 2500);
  EXPECT_EQ(whole.hashes(), resumed.hashes());
}

TEST(PlanarRun, the_penalty_contact_needs_rigid_ground_that_is_alike_across) {
  EXPECT_TRUE(holds(PlanarRun(json::object(), {{"engine", "scm"}}).complaint(),
                    "key 'terrain.engine': is 'scm', expected 'rigid'"));
  const testing::TemporaryFolder folder;
  const std::filesystem::path map = folder.path() / "map.csv";
  std::ofstream(map) << "x_m,y_m,z_m\n0,-3,0\n0,3,0\n5,-3,0\n5,3,0.1\n";
  EXPECT_TRUE(holds(PlanarRun(json::object(), {{"profile_file", map.string()}}).complaint(),
                    "key 'terrain.profile_across': is true and terrain.profile_file has heights that change across"));
  const json cut = {{"profile_file", map.string()}, {"profile_across", false}};
  EXPECT_EQ(PlanarRun(json::object(), cut).complaint(), "");
}

}  // namespace
}  // namespace furrow
