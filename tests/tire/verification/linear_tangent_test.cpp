// The inflated tire compared with its own tangent: for small loads, inflate() and PressSolver must agree with it. This
// checks the solvers and not the tire, since both use the same stiffness.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/linear_plate.hpp"
#include "tests/verification/record.hpp"
#include "tire/ancf/press_solver.hpp"

namespace furrow::test {
namespace {

constexpr double kLoad = 4561.65;  // N: 465 kg
constexpr double kReach = 0.03;    // m

tire::TireFile tire_at(const char* name, double pressure, int columns, int width) {
  tire::TireFile file = small_file(name, columns, width);
  file.pressure = pressure;
  return file;
}

std::string said(const char* name, double pressure, int columns, int width) {
  return fmt::format("{}, {:g} kPa, {} x {}", std::string(name).substr(6, 7), pressure / 1e3, columns, width);
}

double crown(const InflatedCarcass& ring) {
  return ring.shell.layout().get(ring.q, 0, ring.mesh.rows / 2, 0).z() - ring.file.radius;
}

/// Growth of the crown by the tangent of the undeformed tire: K₀ u = p ∂V/∂q.
double linear_growth(const char* name, double pressure, int columns, int width) {
  const InflatedCarcass ring(tire_at(name, 0.0, columns, width));
  tire::ShellCarcass pressed = ring.shell;
  pressed.set_pressure(pressure);
  const tire::ShellLayout& layout = ring.shell.layout();
  tire::Field strains, force(layout.size());
  pressed.strains(ring.q, strains);
  pressed.forces(ring.q, ring.q, strains, 0.0, force);
  Vector load(6 * (ring.mesh.rows - 2));
  for (int j = 1; j + 1 < ring.mesh.rows; ++j)
    for (int s = 0; s < 6; ++s) load[6 * (j - 1) + s] = -force[layout.offset(j, s)];
  const Vector u = ring.stiffness(0).real().partialPivLu().solve(load);
  return u[6 * (ring.mesh.rows / 2 - 1) + 2];
}

TEST(LinearTangent, a_little_pressure_lifts_the_crown_as_the_tangent_says) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json"}) {
    const double pressure = 200.0;  // Pa
    verification::verify("inflation beside the tangent at rest", "crown growth, m, " + said(name, pressure, 90, 24),
                         crown(InflatedCarcass(tire_at(name, pressure, 90, 24))), linear_growth(name, pressure, 90, 24),
                         0.02, "linear: tangent of the undeformed ring");
  }
}

TEST(LinearTangent, a_plate_that_hardly_presses_is_borne_as_the_tangent_says) {
  for (const auto& [name, pressure] : {std::pair("hmmwv_lumped.json", 200e3), std::pair("hmmwv_layered.json", 20e3)}) {
    const InflatedCarcass ring(tire_at(name, pressure, 90, 24));
    const LinearPlate linear(ring, kReach);
    tire::PressSolver solver(ring.file, ring.mesh, ring.q, {});
    const auto off = [&](double deflection, double& force, double& reference) {
      const LinearPlate::Answer answer = linear.at_deflection(deflection);
      EXPECT_TRUE(answer.found);
      force = solver.press(deflection).force, reference = answer.force;
      return std::abs(force / reference - 1.0);
    };
    double force = 0.0, reference = 0.0;
    const double farther = off(4e-4, force, reference);
    EXPECT_LT(off(2e-4, force, reference), 0.5 * farther);  // it is the limit of small deflections
    verification::verify("plate beside the tangent as inflated", "force at 0.2 mm, N, " + said(name, pressure, 90, 24),
                         force, reference, 0.03, "linear: compliance of the inflated ring, unilateral contact");
  }
}

struct Case {
  const char* name;
  double pressure;
  int columns, width;
};

/// With FURROW_LINEAR_PLATE_CSV set, writes a line of that file.
void record(const Case& c, const LinearPlate::Answer& answer) {
  const char* path = std::getenv("FURROW_LINEAR_PLATE_CSV");
  if (path == nullptr || *path == '\0') return;
  std::ofstream out(path, std::ios::app);
  if (out.tellp() == 0) out << "tire,pressure_Pa,mesh,load_N,deflection_m,secant_N_per_m,tangent_N_per_m\n";
  out << fmt::format("{},{:g},{}x{},{:.6g},{:.5g},{:.4g},{:.4g}\n", c.name, c.pressure, c.columns, c.width,
                     answer.force, answer.deflection, answer.force / answer.deflection, answer.tangent);
}

TEST(LinearTangent, under_the_load_the_pressed_tire_yields_more_than_its_tangent) {
  for (const Case& c : {Case{"hmmwv_lumped.json", 200e3, 60, 12}, Case{"hmmwv_lumped.json", 200e3, 90, 24},
                        Case{"hmmwv_layered.json", 70e3, 60, 12}, Case{"hmmwv_layered.json", 70e3, 90, 24},
                        Case{"hmmwv_layered.json", 200e3, 60, 12}, Case{"hmmwv_layered.json", 200e3, 90, 24}}) {
    const InflatedCarcass ring(tire_at(c.name, c.pressure, c.columns, c.width));
    const LinearPlate::Answer linear = LinearPlate(ring, kReach).at_load(kLoad);
    ASSERT_TRUE(linear.found) << said(c.name, c.pressure, c.columns, c.width);
    EXPECT_GT(linear.tangent, linear.force / linear.deflection);  // the contact grows
    record(c, linear);
    if (c.pressure < 200e3 || std::string(c.name) != "hmmwv_lumped.json" || c.columns > 60) continue;
    tire::PressSolver solver(ring.file, ring.mesh, ring.q, {});
    EXPECT_LT(solver.press(linear.deflection).force, kLoad);
  }
}

}  // namespace
}  // namespace furrow::test
