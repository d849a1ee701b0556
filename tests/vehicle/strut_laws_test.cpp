// Tables, springs with stops and shock absorbers: values, slopes, integrals and energies.
#include "vehicle/multibody/strut_laws.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include "protocol/core/error.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::Table, vehicle::TableCurve, vehicle::TableEnd;

namespace {

// Front spring of a HMMWV: N at m.
const std::vector<std::pair<double, double>> kSpring = {
    {0.02, 3629.923},  {0.04, 8991.945},   {0.06, 17818.165},  {0.08, 31840.681},  {0.10, 52791.592},
    {0.12, 82402.997}, {0.14, 122406.996}, {0.16, 174535.686}, {0.18, 240521.166}, {0.20, 322095.536}};
const std::vector<std::pair<double, double>> kStop = {{0.0, 0.0},     {0.01, 1000.0},  {0.02, 2500.0},  {0.03, 4500.0},
                                                      {0.04, 7500.0}, {0.05, 12500.0}, {0.06, 125000.0}};

vehicle::ShockOptions hmmwv_shock() {
  vehicle::ShockOptions o;
  o.bump = 12522;
  o.rebound = 22460;
  o.outer_bump = 5896;
  o.outer_rebound = 60068;
  o.first_mark = 0.324;
  o.last_mark = 0.419;
  o.blend_length = 0.004;
  o.blend_speed = 0.01;
  return o;
}

}  // namespace

TEST(Table, meets_its_points_and_slope_and_integral_belong_to_its_value) {
  for (const TableCurve curve : {TableCurve::linear, TableCurve::monotone_cubic}) {
    for (const TableEnd end : {TableEnd::constant, TableEnd::straight}) {
      const Table table = Table::odd("spring", kSpring, curve, end);
      for (const auto& [x, y] : kSpring) {
        EXPECT_NEAR(table.value(x), y, 1e-9);
        EXPECT_NEAR(table.value(-x), -y, 1e-9);
      }
      EXPECT_EQ(table.integral(0.0), 0.0);
      const double d = 1e-5;
      for (double x = -0.2453; x < 0.25; x += 0.0037) {
        EXPECT_NEAR((table.value(x + d) - table.value(x - d)) / (2 * d), table.slope(x),
                    1e-5 * std::abs(table.slope(x)) + 1.0)
            << x;
        EXPECT_NEAR((table.integral(x + d) - table.integral(x - d)) / (2 * d), table.value(x),
                    1e-4 * std::abs(table.value(x)) + 1e-3)
            << x;
      }
    }
  }
}

TEST(Table, monotone_curve_rises_with_its_points_and_has_no_overshoot_at_a_plateau) {
  const Table table("steps", {{0, 0}, {1, 0}, {2, 5}, {2.1, 5.1}, {4, 5.1}}, TableCurve::monotone_cubic);
  double before = 0.0;
  for (double x = 0.0; x <= 4.0; x += 0.01) {
    EXPECT_GE(table.value(x), before - 1e-14);
    before = table.value(x);
  }
  EXPECT_LE(before, 5.1 + 1e-14);
}

TEST(Table, wrong_tables_are_refused_with_what_was_expected) {
  const auto text_of = [](const auto& make) { return refusal(ExitCode::physics, make); };
  EXPECT_TRUE(holds(text_of([] { Table("map", {{0, 1}}); }), "two points"));
  EXPECT_TRUE(holds(text_of([] { Table("map", {{0, 1}, {2, 1}, {2, 3}}); }), "expected rising"));
  EXPECT_TRUE(holds(text_of([] { Table("map", {{0, 1}, {2, std::nan("")}}); }), "finite"));
  EXPECT_TRUE(holds(text_of([] { Table::odd("map", {{-1, 1}, {2, 3}}); }), "expected a positive"));
}

namespace {

struct Strut {
  vehicle::System system;
  int mass, element = -1, shock = -1;
  Strut(double m, double length, double speed, const Vec3& gravity, const vehicle::ForceLaw& spring,
        const vehicle::ForceLaw& damper)
      : system(gravity) {
    vehicle::BodyState state;
    state.position = Vec3(0, 0, length);
    state.velocity = Vec3(0, 0, speed);
    mass = system.add_body("mass", m, Mat3::Identity(), state);
    const int guide = system.add_joint(vehicle::JointKind::prismatic, "guide", vehicle::kGround, mass,
                                       slide(state.position, Vec3::UnitZ()));
    (void)guide;
    if (spring)
      element = system.add_line_element("spring", vehicle::kGround, mass, Vec3::Zero(), state.position, spring),
      system.track_energy(element);
    if (damper)
      shock = system.add_line_element("shock", vehicle::kGround, mass, Vec3::Zero(), state.position, damper),
      system.track_energy(shock);
    system.assemble(0.0);
  }
  double length() const { return system.body(mass).state.position.z(); }
  double energy() const { return system.kinetic_energy() + system.gravity_energy(); }
};

vehicle::ForceLaw front_spring() {
  vehicle::SpringOptions o;
  o.force = Table::odd("spring", kSpring);
  o.stop = Table("stop", kStop);
  o.free_length = 0.339;
  o.shortest = 0.15;
  o.longest = 0.30;
  return vehicle::tabulated_spring(o);
}

}  // namespace

TEST(Spring, force_and_energy_of_the_stops_add_to_the_table) {
  const vehicle::ForceLaw law = front_spring();
  EXPECT_NEAR(law(0.239, 0, 0).force, 52791.592, 1e-6);                // 100 mm
  EXPECT_NEAR(law(0.139, 0, 0).force, 322095.536 + 1150.0, 1e-6);      // 200 mm and 11 mm into the stop
  EXPECT_NEAR(law(0.325, 0, 0).force, 3629.923 * 0.7 - 3500.0, 1e-6);  // 14 mm and 25 mm beyond the long mark
  for (double x = 0.1; x < 0.4; x += 0.0017) {
    const double d = 1e-6;
    EXPECT_NEAR(-(law(x + d, 0, 0).energy - law(x - d, 0, 0).energy) / (2 * d), law(x, 0, 0).elastic,
                1e-5 * std::abs(law(x, 0, 0).elastic) + 20.0)
        << x;
  }
}

TEST(Spring, mass_that_bounces_between_the_stops_keeps_energy_to_second_order) {
  const auto error_of = [](int steps) {
    Strut strut(500.0, 0.25, 4.0, standard_gravity(), front_spring(), nullptr);
    const double start = strut.energy() + strut.system.element_energy(strut.element).stored;
    double worst = 0.0;
    for (int i = 0; i < steps; ++i) {
      EXPECT_TRUE(strut.system.step(0.5 / steps).ok);
      worst = std::max(worst, std::abs(strut.energy() + strut.system.element_energy(strut.element).stored - start));
    }
    // The elastic part's work equals the gain of kinetic and gravity energy, and nothing is dissipated.
    const vehicle::ElementEnergy energy = strut.system.element_energy(strut.element);
    EXPECT_LT(std::abs(energy.dissipated), 1e-9);
    return worst;
  };
  const double coarse = error_of(2000), fine = error_of(8000);
  EXPECT_LT(fine, 0.002 * 0.5 * 500.0 * 16.0);
  EXPECT_GT(coarse / fine, 8.0);
}

TEST(Shock, coefficient_is_continuous_keeps_its_values_away_from_the_marks_and_always_takes_energy) {
  const vehicle::ShockOptions o = hmmwv_shock();
  EXPECT_EQ(vehicle::shock_coefficient(o, 0.37, -0.3), 12522);
  EXPECT_EQ(vehicle::shock_coefficient(o, 0.37, 0.3), 22460);
  EXPECT_EQ(vehicle::shock_coefficient(o, 0.30, -0.3), 5896);
  EXPECT_EQ(vehicle::shock_coefficient(o, 0.43, 0.3), 60068);
  EXPECT_NEAR(vehicle::shock_coefficient(o, 0.324, 0.3), 0.5 * (22460 + 60068), 1e-9);
  for (double v = -0.5; v <= 0.5; v += 0.01) {
    double before = vehicle::shock_coefficient(o, 0.30, v);
    for (double x = 0.30; x < 0.45; x += 1e-5) {
      const double c = vehicle::shock_coefficient(o, x, v);
      EXPECT_GE(c, 0.0);
      ASSERT_LT(std::abs(c - before), 300.0) << x;  // 1.875 · 54,000 · 1e-5/0.004 = 253
      before = c;
    }
  }
}

TEST(Shock, dissipated_energy_is_what_the_mass_loses_through_bump_rebound_and_marks) {
  Strut strut(600.0, 0.40, -2.5, Vec3::Zero(), vehicle::linear_spring_damper(2e5, 0.37, 0.0),
              vehicle::shock_absorber(hmmwv_shock()));
  const auto stored = [&] { return 0.5 * 2e5 * std::pow(strut.length() - 0.37, 2); };
  const double start = strut.energy() + stored();
  double before = 0.0;
  for (int i = 0; i < 4000; ++i) {
    ASSERT_TRUE(strut.system.step(1e-4).ok);
    const double taken = strut.system.element_energy(strut.shock).dissipated;
    EXPECT_GE(taken, before - 1e-3);
    before = taken;
  }
  EXPECT_GT(before, 0.5 * start);
  EXPECT_NEAR(before + strut.energy() + stored(), start, 1e-3 * start);
}

TEST(Shock, contradicting_options_are_refused) {
  vehicle::ShockOptions o = hmmwv_shock();
  o.blend_length = 0.0;
  EXPECT_THROW(vehicle::shock_absorber(o), Error);
  o = hmmwv_shock();
  o.last_mark = 0.3;
  EXPECT_THROW(vehicle::shock_absorber(o), Error);
  o = hmmwv_shock();
  o.outer_bump = -1.0;
  EXPECT_THROW(vehicle::shock_absorber(o), Error);
  EXPECT_THROW(vehicle::tabulated_spring({}), Error);
  EXPECT_EQ(names_of<vehicle::ElementEnergy>().size(), member_count<vehicle::ElementEnergy>());
}
