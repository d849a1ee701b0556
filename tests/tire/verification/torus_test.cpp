// Inflated tires: membrane theory of the torus, equilibrium of the whole ring, growth with pressure.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/curves.hpp"
#include "tests/tire/verification/cyclic.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using verification::verify;

std::string size(int n, int m) { return std::to_string(n) + " x " + std::to_string(m); }

TEST(Torus, membrane_forces) {
  // Half torus, tube radius a on a rim of radius b, 1 mm thick, at small strain. θ from the crown:
  //   N_hoop = p a/2,  N_meridian = p a (2 b + a cos θ)/(2 (b + a cos θ));  bending is left to the beads.
  const double a = 0.195, b = 0.35;
  for (const int width : {12, 24, 48, 96}) {
    TireFile file = small_file("toroidal.json", 2 * width, width);
    for (Section* s : {&file.bead, &file.sidewall, &file.tread}) s->layers[0].thickness = 1e-3;
    file.pressure = 100.0;
    const InflatedRing ring(file);
    const ShellPatch column(ring_patch_mesh(ring.mesh, true), shell_layers(file, file.tread));
    Vector q(column.coordinates());
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < ring.mesh.rows; ++j)
        for (const int s : {0, 3})
          q.segment<3>(6 * (i * ring.mesh.rows + j) + s) = ring.shell.layout().get(ring.q, i, j, s);
    verification::Worst hoop("inflated torus, |theta| < 60 deg", "N around / (p a), " + size(2 * width, width),
                             std::max(0.01, 6.0 / (width * width)), "p a/2, membrane theory"),
        meridian("inflated torus, |theta| < 60 deg", "N along the meridian / (p a), " + size(2 * width, width),
                 std::max(0.01, 6.0 / (width * width)), "p a (2 b + a cos)/(2 (b + a cos)), membrane theory");
    for (int j = 0; j < width; ++j) {
      const double theta = std::numbers::pi * ((j + 0.5) / width - 0.5);
      if (std::abs(theta) > std::numbers::pi / 3) continue;
      const auto n = column.resultants(q, j);
      const double r = b + a * std::cos(theta), scale = file.pressure * a;
      const std::string where = verification::brief(theta * 180 / std::numbers::pi) + " deg";
      hoop.add(n[0] / scale, 0.5, 0.0, where);
      meridian.add(n[1] / scale, (r + b) / (2 * r), 0.0, where);
    }
  }
}

TEST(Inflated, whole_ring_is_in_axisymmetric_equilibrium) {
  for (const char* name : {"hmmwv_lumped.json", "toroidal.json"}) {
    const InflatedRing ring(small_file(name, 90, 24));
    const RingLayout& layout = ring.shell.layout();
    ShellRing bare = ring.shell;
    bare.set_pressure(0.0);
    const Field at_rest(ring.shell.strains_size(), 0.0);
    Field f(layout.size()), elastic(layout.size());
    ring.shell.forces(ring.q, ring.q, at_rest, 1.0, f);
    bare.forces(ring.q, ring.q, at_rest, 1.0, elastic);
    double residual = 0.0, pressure = 0.0, asymmetry = 0.0;
    for (int j = 1; j + 1 < layout.rows; ++j)
      for (int i = 0; i < layout.columns; ++i) {
        residual = std::max(residual, layout.get(f, i, j, 0).norm());
        pressure = std::max(pressure, (layout.get(f, i, j, 0) - layout.get(elastic, i, j, 0)).norm());
        asymmetry = std::max(asymmetry, (layout.get(ring.q, i, j, 0) -
                                         ring.mesh.turn(i) * layout.get(ring.q, 0, j, 0)).norm());
      }
    const std::string tire = std::string("inflated ") + name;
    verify(tire, "largest nodal force left, of the largest pressure force, 90 x 24", residual / pressure, 0.0, 1e-6, "equilibrium", 1.0);
    verify(tire, "runout, m, 90 x 24", asymmetry, 0.0, 1e-14, "axisymmetry", 1.0);
    double smallest = 1e300;
    for (int order = 0; order <= 45; ++order) smallest = std::min(smallest, ring.smallest_eigenvalue(order));
    EXPECT_GT(smallest, 0.0) << name << " is unstable";
  }
}

TEST(Inflated, growth_converges_with_the_mesh) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json", "toroidal.json"}) {
    double crown[4];
    const int widths[4] = {12, 24, 48, 96};
    for (int k = 0; k < 4; ++k) {
      const InflatedRing ring(small_file(name, 180, widths[k]));
      crown[k] = 1e3 * (ring.shell.layout().get(ring.q, 0, widths[k] / 2, 0).norm() - ring.file.radius);
    }
    const double limit = crown[3] + (crown[3] - crown[2]) / 3;
    for (int k = 0; k < 3; ++k)
      verify(std::string("inflated ") + name, "crown growth, mm, " + size(180, widths[k]), crown[k], limit,
             20.0 / (widths[k] * widths[k]), "extrapolated in the mesh");
  }
}

TEST(Inflated, growth_with_pressure) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json"}) {
    double before = 0.0;
    for (const double pressure : {25e3, 50e3, 100e3, 150e3, 200e3, 250e3, 300e3}) {
      TireFile file = small_file(name, 90, 24);
      file.pressure = pressure;
      const InflatedRing ring(file);
      const RingLayout& layout = ring.shell.layout();
      const double crown = layout.get(ring.q, 0, 12, 0).norm() - file.radius;
      double widest = 0.0;
      for (int j = 0; j < layout.rows; ++j)
        widest = std::max(widest, std::abs(layout.get(ring.q, 0, j, 0).y() - ring.mesh.position[j].y()));
      verification::curve_point("inflation", std::string(name) + ", crown growth, mm", pressure / 1e3, 1e3 * crown);
      verification::curve_point("inflation", std::string(name) + ", largest axial shift, mm", pressure / 1e3, 1e3 * widest);
      EXPECT_GT(crown, before) << name << " at " << pressure;
      before = crown;
    }
  }
}

}  // namespace
}  // namespace furrow::test
