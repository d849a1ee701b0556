// Static inflation: residual, symmetry, proportion. Tests of the crown's growth are in tests/tire/verification.
#include "tire/ancf/inflation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "protocol/core/error.hpp"
#include "small_tire.hpp"
#include "tests/refusal.hpp"

namespace furrow::test {
namespace {

/// A tire on the way to its pressure.
struct Inflated {
  tire::ShellMesh mesh;
  tire::ShellCarcass shell;
  tire::InflationReport report;
  tire::Field q;

  explicit Inflated(const tire::TireFile& file)
      : mesh(tire::make_shell_mesh(file)), shell(file, mesh), q(tire::inflate(shell, mesh, report)) {}
  double crown() const { return shell.layout().get(q, 0, mesh.rows / 2, 0).norm(); }
};

TEST(Inflation, layered_crown_grows_less_than_a_free_ring_of_its_hoop_stiffness) {
  const tire::TireFile file = small_file("hmmwv_layered.json", 60, 24);
  const Inflated inflated(file);
  EXPECT_LT(inflated.report.residual, 1e-7);
  const double crown = inflated.crown();
  const double hoop = 61e6;  // N/m, A₁₁ − A₁₂²/A₂₂ of the tread by laminate theory
  EXPECT_GT(crown, file.radius);
  EXPECT_LT(crown - file.radius, file.pressure * file.radius * file.radius / hoop);
}

TEST(Inflation, shape_is_axisymmetric_and_mirrored) {
  const Inflated inflated(small_file("toroidal.json", 24, 12));
  const tire::Field& q = inflated.q;
  const tire::ShellMesh& mesh = inflated.mesh;
  const tire::ShellLayout& layout = inflated.shell.layout();
  for (int j = 0; j < mesh.rows; ++j) {
    const Vec3 here = layout.get(q, 0, j, 0), there = layout.get(q, 0, mesh.rows - 1 - j, 0);
    EXPECT_LT((layout.get(q, 7, j, 0) - mesh.turn(7) * here).norm(), 1e-12);
    EXPECT_NEAR(here.z(), there.z(), 1e-9);
    EXPECT_NEAR(here.y(), -there.y(), 1e-9);
  }
}

TEST(Inflation, pressure_zero_leaves_the_reference) {
  tire::TireFile file = small_file();
  file.pressure = 0.0;
  const Inflated flat(file);
  EXPECT_EQ(flat.q, tire::undeformed(flat.mesh));
}

TEST(Inflation, at_low_pressure_growth_is_linear_on_fine_meshes_too) {
  double growth[2];
  for (int k = 0; k < 2; ++k) {
    tire::TireFile file = small_file("hmmwv_layered.json", 180, 48);
    file.pressure = k == 0 ? 2e3 : 4e3;
    const Inflated inflated(file);
    growth[k] = inflated.crown() - file.radius;
    EXPECT_LT(inflated.report.residual, 1e-6);
  }
  EXPECT_NEAR(growth[1] / growth[0], 2.0, 0.02);
}

TEST(Inflation, at_ten_times_the_pressure_it_converges_and_beyond_it_says_what_is_missing) {
  tire::TireFile file = small_file();
  file.pressure = 2e6;
  EXPECT_LT(Inflated(file).report.residual, 1e-6);
  file.pressure = 1e8;
  expect_refused(ExitCode::physics,
                 {"tire inflation to 1e+08 Pa did not converge: the pressure was reached, but", "; try "},
                 [&] { Inflated{file}; });
}

TEST(Inflation, all_shipped_tires_inflate_at_low_and_full_pressure) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json", "toroidal.json", "passenger_205_55r16.json"})
    for (const double share : {0.35, 1.0, 1.5}) {
      tire::TireFile file = small_file(name, 30, 12);
      file.pressure *= share;
      EXPECT_LT(Inflated(file).report.residual, 1e-6) << name << " at " << file.pressure;
    }
}

}  // namespace
}  // namespace furrow::test
