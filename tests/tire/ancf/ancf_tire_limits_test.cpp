// A tire at the limits of its range: changing and missing pressure, the rim, forces that are not finite.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "small_tire.hpp"
#include "tests/refusal.hpp"
#include "tire/ancf/inflation.hpp"

namespace furrow::test {
namespace {

/// Radius of the crown over the rim's centre, m.
double crown(const tire::AncfTire& tire) {
  const tire::ShellLayout& layout = tire.integrator().layout();
  return layout.get(tire.integrator().q(), 0, layout.rows / 2, 0).norm();
}

TEST(AncfTirePressure, a_tire_let_down_comes_to_the_shape_of_one_inflated_to_that_pressure) {
  tire::TireFile file = small_file("hmmwv_lumped.json");
  LedTire down({}, file);
  file.pressure = 60e3;
  LedTire low({}, file);
  const double full = crown(down.tire);
  for (int n = 0; n < 400; ++n) {
    down.tire.set_pressure(200e3 - 140e3 * std::min(1.0, n / 300.0));
    down.hold(1, 2e-4);
  }
  down.hold(800, 2e-4);
  low.hold(800, 2e-4);
  EXPECT_GT(full - crown(low.tire), 1e-4);
  EXPECT_NEAR(crown(down.tire), crown(low.tire), 1e-3 * (full - crown(low.tire)));
}

TEST(AncfTirePressure, energy_balances_while_the_pressure_changes) {
  LedTire led({}, small_file("hmmwv_lumped.json"));
  tire::AncfTire& tire = led.tire;
  led.hold(200, 2e-4);  // hangs in the rim
  const tire::TireDiagnostics start = tire.diagnostics();
  const double elastic = tire.integrator().elastic_energy();
  for (int n = 0; n < 500; ++n) {
    tire.set_pressure(200e3 - 300.0 * n);
    led.hold(1, 2e-4);
  }
  const tire::TireDiagnostics end = tire.diagnostics();
  const double given_back = elastic - tire.integrator().elastic_energy();  // to the air
  EXPECT_GT(given_back, 1.0);                                              // J
  EXPECT_NEAR(end.strain_energy() + end.kinetic_energy + end.dissipation,
              start.strain_energy() + start.kinetic_energy + start.dissipation, 0.02 * given_back);
}

TEST(AncfTirePressure, a_flat_tire_can_be_loaded) {
  tire::TireFile file = small_file();
  file.pressure = 0.0;
  Rolling rolling(file);
  rolling.intervals(400);
  EXPECT_GT(rolling.tire.spindle_wrench().force.z(), 20.0);
}

TEST(RimClearance, of_the_undeformed_torus_is_the_height_of_its_first_row_less_half_its_thickness) {
  const tire::TireFile file = small_file("toroidal.json", 24, 12);
  const tire::ShellMesh mesh = tire::make_shell_mesh(file);
  const tire::ShellLayout layout{mesh.columns, mesh.rows};
  const tire::RimClearance::Nodes nodes =
      tire::RimClearance(file, mesh).measure(layout, tire::undeformed(mesh), RimState{});
  EXPECT_TRUE(nodes.row == 1 || nodes.row == mesh.rows - 2);
  EXPECT_NEAR(nodes.clearance, 0.195 * std::sin(std::numbers::pi / 12) - 0.007, 1e-4);
  EXPECT_NEAR(nodes.farthest, 0.545, 1e-3);
}

TEST(RimClearance, does_not_depend_on_where_the_rim_is) {
  tire::AncfTire tire(small_file());
  RimState rim;
  rim.position = Vec3(3, -1, 2);
  rim.orientation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
  tire.place(rim);
  const tire::ShellLayout& layout = tire.integrator().layout();
  const tire::RimClearance clearance(small_file(), tire::make_shell_mesh(small_file()));
  const auto moved = clearance.measure(layout, tire.integrator().q(), rim);
  tire.place(RimState{});
  const auto still = clearance.measure(layout, tire.integrator().q(), RimState{});
  EXPECT_NEAR(moved.clearance, still.clearance, 1e-12);
  EXPECT_NEAR(moved.farthest, still.farthest, 1e-12);
}

TEST(RimClearance, a_tire_pressed_down_to_its_rim_stops_with_node_and_clearance) {
  tire::TireFile file = small_file();
  file.pressure = 30e3;
  RimState rim;
  rim.position.z() = tire::AncfTire(file).radius();
  LedTire led(rim, file);
  const double h = 2e-4;
  Outcome status;
  for (int n = 0; n < 1500 && status.ok; ++n) {
    rim.velocity.z() = -1.0;  // m/s
    const RimState at = rim;
    rim.position.z() -= h;
    status = led.advance(at, h, ground_forces(led.tire));
  }
  EXPECT_EQ(status.what, "reached its rim") << status.message("tire");
  for (const char* word : {"clearance -", "column"}) EXPECT_TRUE(holds(status.detail, word));
  EXPECT_LT(rim.position.z(), file.rim_radius + 0.06);  // the crown buckles upwards, off the ground
  EXPECT_GT(rim.position.z(), file.rim_radius - 0.01);
}

TEST(AncfTireLimits, a_force_that_is_not_finite_is_named_and_changes_nothing) {
  LedTire led({}, small_file());
  const tire::Field before = led.tire.integrator().q();
  const Outcome status = led.advance({}, 1e-4, {{17}, {Vec3(0, 0, std::numeric_limits<double>::quiet_NaN())}});
  EXPECT_FALSE(status.ok);
  EXPECT_TRUE(holds(status.message("tire"), "vertex 17"));
  EXPECT_EQ(led.tire.integrator().q(), before);
}

TEST(AncfTireLimits, tread_rubber_adds_its_mass_to_tire_weight_and_to_what_a_contact_moves) {
  tire::TireFile bare = small_file(), heavy = small_file();
  heavy.tread_mass_per_area = 20.0;
  const tire::AncfTire light(bare);
  LedTire led({}, heavy);
  const tire::AncfTire& tire = led.tire;
  EXPECT_NEAR(tire.material().area_density - light.material().area_density, 20.0, 1e-12);
  led.hold(1500, 2e-4);
  const double mass = tire.mass_properties().mass;
  EXPECT_GT(mass, light.mass_properties().mass + 9.0);
  EXPECT_NEAR(tire.spindle_wrench().force.z(), -9.81 * mass, 0.01 * 9.81 * mass);
}

}  // namespace
}  // namespace furrow::test
