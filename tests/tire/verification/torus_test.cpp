// Inflated tires: membrane theory of the torus, equilibrium of the whole ring, growth with pressure.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/curves.hpp"
#include "tests/tire/verification/cyclic.hpp"
#include "tests/tire/verification/mesh_size.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using verification::verify;

/// Membrane forces over p a of an inflated half torus, of tube radius a on a rim of radius b; θ from the crown.
struct TorusPoint {
  double theta, around, meridian;
};
constexpr double kTube = 0.195, kRim = 0.35;  // m

/// Coordinates of the first column of elements.
Vector column_of(const InflatedCarcass& ring) {
  Vector q(12 * ring.mesh.rows);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < ring.mesh.rows; ++j)
      for (const int s : {0, 3})
        q.segment<3>(6 * (i * ring.mesh.rows + j) + s) = ring.shell.layout().get(ring.q, i, j, s);
  return q;
}

std::vector<TorusPoint> inflated_torus(int columns, int width, double thickness) {
  tire::TireFile file = small_file("toroidal.json", columns, width);
  for (tire::Section* s : {&file.bead, &file.sidewall, &file.tread}) s->layers[0].thickness = thickness;
  file.pressure = 5e5 * thickness;  // strains of 1e-3
  const InflatedCarcass ring(file);
  const ShellPatch column(ring_patch_mesh(ring.mesh, true), tire::shell_layers(file, file.tread));
  const Vector q = column_of(ring);
  std::vector<TorusPoint> points;
  for (int j = 0; j < width; ++j) {
    const Eigen::Matrix<double, 6, 1> n = column.resultants(q, j) / (file.pressure * kTube);
    points.push_back({std::numbers::pi * ((j + 0.5) / width - 0.5), n[0], n[1]});
  }
  return points;
}

TEST(Torus, membrane_forces) {
  //   N_meridian = p a (2 b + a cos θ)/(2 (b + a cos θ)),  N_around = p a/2
  // need edges free of shear. The clamped beads bend the meridian, which shifts the constant of integration; for any
  // edge, N_meridian/a + N_around cos θ/r = p.
  const char* theory = "membrane theory (Flugge 1973, ch. 2)";
  for (const double thickness : {2e-3, 0.5e-3})
    for (const int width : {12, 24, 48}) {
      const std::string mesh = size(2 * width, width),
                        name = "inflated torus, h/a = " + verification::brief(thickness / kTube);
      const double tolerance = 1.2 / (width * width) + 1e-3;
      verification::Worst balance(name, "N meridian/(p a) + N around cos/(p r), |theta| < 30 deg, " + mesh, tolerance,
                                  theory),
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
    const InflatedCarcass ring(small_file(name, 90, 24));
    const tire::ShellLayout& layout = ring.shell.layout();
    tire::ShellCarcass bare = ring.shell;
    bare.set_pressure(0.0);
    const tire::Field at_rest(ring.shell.strains_size(), 0.0);
    tire::Field f(layout.size()), elastic(layout.size());
    ring.shell.forces(ring.q, ring.q, at_rest, 1.0, f);
    bare.forces(ring.q, ring.q, at_rest, 1.0, elastic);
    double residual = 0.0, pressure = 0.0, asymmetry = 0.0;
    for (int j = 1; j + 1 < layout.rows; ++j)
      for (int i = 0; i < layout.columns; ++i) {
        residual = std::max(residual, layout.get(f, i, j, 0).norm());
        pressure = std::max(pressure, (layout.get(f, i, j, 0) - layout.get(elastic, i, j, 0)).norm());
        asymmetry =
            std::max(asymmetry, (layout.get(ring.q, i, j, 0) - ring.mesh.turn(i) * layout.get(ring.q, 0, j, 0)).norm());
      }
    const std::string tire = std::string("inflated ") + name;
    verification::verify(tire, "largest nodal force left, of the largest pressure force, 90 x 24", residual / pressure,
                         0.0, 1e-6, "equilibrium", 1.0);
    verification::verify(tire, "runout, m, 90 x 24", asymmetry, 0.0, 1e-14, "axisymmetry", 1.0);
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
      const InflatedCarcass ring(small_file(name, 180, widths[k]));
      crown[k] = 1e3 * (ring.shell.layout().get(ring.q, 0, widths[k] / 2, 0).norm() - ring.file.radius);
    }
    const double limit = crown[2] + (crown[2] - crown[1]) / 3;
    for (int k = 0; k < 3; ++k)
      verification::verify(std::string("inflated ") + name, "crown growth, mm, " + size(180, widths[k]), crown[k],
                           limit, 20.0 / (widths[k] * widths[k]), "extrapolated in the mesh");
  }
}

TEST(Inflated, crown_of_the_lumped_tire_carries_the_pressure_by_its_hoop_stiffness) {
  //   N_hoop/R + N_meridian κ − M_meridian'' = p          balance of forces along the normal (Flugge 1973, ch. 2, 5)
  //   (R/R₀)² = 1 + 2 (N_hoop − ν N_meridian)/(E h)       Hooke, S = C E; E, ν of the tread's single layer
  // and on their own a free ring: growth p R²/(E h) = 7.2 mm.
  for (const int width : {24, 48}) {
    const InflatedCarcass ring(small_file("hmmwv_lumped.json", 180, width));
    const ShellPatch column(ring_patch_mesh(ring.mesh, true), tire::shell_layers(ring.file, ring.file.tread));
    const Vector q = column_of(ring);
    const int crown = width / 2;
    Eigen::Matrix<double, 6, 1> n[4];  // elements −2, −1, 1, 2 from the crown
    for (int k = 0; k < 4; ++k) n[k] = column.resultants(q, crown - 2 + k);
    const auto at = [&](int j) { return ring.shell.layout().get(ring.q, 0, j, 0); };
    const Vec3 a = at(crown - 1), b = at(crown), c = at(crown + 1);
    const double h = 0.5 * (c - a).norm(), sag = b.z() - 0.5 * (a.z() + c.z());
    // Resultants are means over the two elements at the crown, and so are the radii.
    const auto mean = [](double low, double middle, double high) { return 0.25 * (low + 2.0 * middle + high); };
    const auto& reference = ring.mesh.position;
    const double radius = mean(a.z(), b.z(), c.z()),
                 radius_0 = mean(reference[crown - 1].z(), reference[crown].z(), reference[crown + 1].z());
    const double stretch = radius / radius_0, along = h / (0.5 * (reference[crown + 1] - reference[crown - 1]).norm());
    const double hoop = 0.5 * (n[1][0] + n[2][0]), meridian = 0.5 * (n[1][1] + n[2][1]);
    const double shear = (n[0][4] - n[1][4] - n[2][4] + n[3][4]) / (2 * h * h);
    const std::string mesh = size(180, width), tire = "inflated hmmwv_lumped.json, crown";
    // Forces per current length from second Piola–Kirchhoff resultants.
    const double carried = hoop * stretch / along / radius + meridian * along / stretch * 2 * sag / (h * h) - shear;
    verification::verify(tire, "N hoop/R + N meridian kappa - M'' over p, " + mesh, carried / ring.file.pressure, 1.0,
                         0.7 / width, "equilibrium (Flugge 1973, ch. 2, 5)");
    const double modulus = 7.522762e8, thickness = 8.1e-3, nu = 0.013982;
    const double strain = (hoop - nu * meridian) / (modulus * thickness);
    verification::verify(tire, "growth by Hooke's law from N hoop, mm, " + mesh, 1e3 * (radius - radius_0),
                         1e3 * radius_0 * (std::sqrt(1 + 2 * strain) - 1), 5e-3,
                         "plane stress, E of the circumference");
    const double free_ring = ring.file.pressure * radius_0 * radius_0 / (modulus * thickness);
    EXPECT_LT(radius - radius_0, free_ring);
    EXPECT_GT(radius - radius_0, 0.75 * free_ring);
  }
}

TEST(Inflated, growth_with_pressure) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json"}) {
    double before = 0.0;
    for (const double pressure : {25e3, 50e3, 100e3, 150e3, 200e3, 250e3, 300e3}) {
      tire::TireFile file = small_file(name, 90, 24);
      file.pressure = pressure;
      const InflatedCarcass ring(file);
      const tire::ShellLayout& layout = ring.shell.layout();
      const double crown = layout.get(ring.q, 0, 12, 0).norm() - file.radius;
      double widest = 0.0;
      for (int j = 0; j < layout.rows; ++j)
        widest = std::max(widest, std::abs(layout.get(ring.q, 0, j, 0).y() - ring.mesh.position[j].y()));
      verification::curve_point("inflation", std::string(name) + ", crown growth, mm", pressure / 1e3, 1e3 * crown);
      verification::curve_point("inflation", std::string(name) + ", largest axial shift, mm", pressure / 1e3,
                                1e3 * widest);
      EXPECT_GT(crown, before) << name << " at " << pressure;
      before = crown;
    }
  }
}

}  // namespace
}  // namespace furrow::test
