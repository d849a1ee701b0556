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

/// Membrane forces over p a of an inflated half torus, of tube radius a on a rim of radius b; θ from the crown.
struct TorusPoint {
  double theta, around, meridian;
};
constexpr double kTube = 0.195, kRim = 0.35;  // m

std::vector<TorusPoint> inflated_torus(int columns, int width, double thickness) {
  TireFile file = small_file("toroidal.json", columns, width);
  for (Section* s : {&file.bead, &file.sidewall, &file.tread}) s->layers[0].thickness = thickness;
  file.pressure = 5e5 * thickness;  // strains of 1e-3
  const InflatedRing ring(file);
  const ShellPatch column(ring_patch_mesh(ring.mesh, true), shell_layers(file, file.tread));
  Vector q(column.coordinates());
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < ring.mesh.rows; ++j)
      for (const int s : {0, 3})
        q.segment<3>(6 * (i * ring.mesh.rows + j) + s) = ring.shell.layout().get(ring.q, i, j, s);
  std::vector<TorusPoint> points;
  for (int j = 0; j < width; ++j) {
    const Eigen::Matrix<double, 6, 1> n = column.resultants(q, j) / (file.pressure * kTube);
    points.push_back({std::numbers::pi * ((j + 0.5) / width - 0.5), n[0], n[1]});
  }
  return points;
}

TEST(Torus, membrane_forces) {
  //   N_meridian = p a (2 b + a cos θ)/(2 (b + a cos θ)),  N_around = p a/2
  // need edges free of shear. The clamped beads bend the meridian, which shifts the constant of integration; what holds
  // for any edge is N_meridian/a + N_around cos θ/r = p.
  const char* theory = "membrane theory (Flugge 1973, ch. 2)";
  for (const double thickness : {2e-3, 0.5e-3})
    for (const int width : {12, 24, 48}) {
      const std::string mesh = size(2 * width, width),
                        name = "inflated torus, h/a = " + verification::brief(thickness / kTube);
      const double tolerance = 1.2 / (width * width) + 1e-3;
      verification::Worst balance(name, "N meridian/(p a) + N around cos/(p r), |theta| < 30 deg, " + mesh,
                                  tolerance, theory),
          around(name, "N around/(p a), |theta| < 30 deg, " + mesh, 0.04 + 6 * tolerance, theory),
          meridian(name, "N meridian/(p a), |theta| < 30 deg, " + mesh, 0.01 + tolerance, theory);
      for (const TorusPoint& point : inflated_torus(2 * width, width, thickness)) {
        if (std::abs(point.theta) > std::numbers::pi / 6) continue;
        const double c = std::cos(point.theta), r = kRim + kTube * c;
        const std::string where = verification::brief(point.theta * 180 / std::numbers::pi) + " deg";
        balance.add(point.meridian + point.around * c * kTube / r, 1.0, 0.0, where);
        around.add(point.around, 0.5, 0.0, where);
        meridian.add(point.meridian, (r + kRim) / (2 * r), 0.0, where);
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
        asymmetry =
            std::max(asymmetry,
                     (layout.get(ring.q, i, j, 0) - ring.mesh.turn(i) * layout.get(ring.q, 0, j, 0)).norm());
      }
    const std::string tire = std::string("inflated ") + name;
    verify(tire, "largest nodal force left, of the largest pressure force, 90 x 24", residual / pressure, 0.0,
           1e-6, "equilibrium", 1.0);
    verify(tire, "runout, m, 90 x 24", asymmetry, 0.0, 1e-14, "axisymmetry", 1.0);
    double smallest = 1e300;
    for (int order = 0; order <= 45; ++order) smallest = std::min(smallest, ring.smallest_eigenvalue(order));
    EXPECT_GT(smallest, 0.0) << name << " is unstable";
  }
}

TEST(Inflated, growth_converges_with_the_mesh) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json", "toroidal.json"}) {
    double crown[3];
    const int widths[3] = {12, 24, 48};
    for (int k = 0; k < 3; ++k) {
      const InflatedRing ring(small_file(name, 180, widths[k]));
      crown[k] = 1e3 * (ring.shell.layout().get(ring.q, 0, widths[k] / 2, 0).norm() - ring.file.radius);
    }
    const double limit = crown[2] + (crown[2] - crown[1]) / 3;
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
      verification::curve_point("inflation", std::string(name) + ", crown growth, mm", pressure / 1e3,
                                1e3 * crown);
      verification::curve_point("inflation", std::string(name) + ", largest axial shift, mm", pressure / 1e3,
                                1e3 * widest);
      EXPECT_GT(crown, before) << name << " at " << pressure;
      before = crown;
    }
  }
}

}  // namespace
}  // namespace furrow::test
