// Laminates: stiffness against classical laminate theory, extension–twist coupling, simply supported cross-ply plates.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/laminate_theory.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using verification::verify;

const char* kClassical = "classical laminate theory (Jones 1999, ch. 4)";
const char* kLinear = "the same with one linear thickness strain through all layers";

/// Graphite–epoxy in ratios, as in most published plates.
Ply graphite() { return {25e9, 1e9, 0.5e9, 0.2e9, 0.25, 0.25}; }

std::vector<tire::ShellLayer> layup(const std::vector<double>& angles, double thickness) {
  std::vector<tire::ShellLayer> layers;
  for (const double a : angles)
    layers.push_back(ply_layer(thickness / static_cast<double>(angles.size()), a, graphite()));
  return layers;
}

struct Laminate {
  std::string name;
  std::vector<tire::ShellLayer> layers;
};

std::vector<Laminate> laminates() {
  std::vector<Laminate> list = {{"laminate [45/-45]", layup({45, -45}, 0.01)},
                                {"laminate [0/90]", layup({0, 90}, 0.01)},
                                {"laminate [0/90/90/0]", layup({0, 90, 90, 0}, 0.01)},
                                {"laminate [30/-60/10]", layup({30, -60, 10}, 0.01)}};
  const tire::TireFile file = small_file();
  list.push_back({"tire, bead", tire::shell_layers(file, file.bead)});
  list.push_back({"tire, sidewall", tire::shell_layers(file, file.sidewall)});
  list.push_back({"tire, tread", tire::shell_layers(file, file.tread)});
  return list;
}

/// The element's [A B; B D]: energies of uniform strains and curvatures, thickness at rest with them.
Abd element_abd(const std::vector<tire::ShellLayer>& layers) {
  const ShellPatch patch(plate_mesh(1, 1, 1.0, 1.0), layers);
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(24, 6);
  for (int n = 0; n < 4; ++n) {
    const double x = patch.reference()[6 * n], y = patch.reference()[6 * n + 1];
    const int u = 6 * n, v = u + 1, w = u + 2, a = u + 3, b = u + 4;
    modes(u, 0) = x, modes(v, 1) = y, modes(u, 2) = 0.5 * y, modes(v, 2) = 0.5 * x;
    modes(a, 3) = x, modes(w, 3) = -0.5 * x * x;
    modes(b, 4) = y, modes(w, 4) = -0.5 * y * y;
    modes(a, 5) = 0.5 * y, modes(b, 5) = 0.5 * x, modes(w, 5) = -0.5 * x * y;
  }
  const Eigen::MatrixXd k = patch.tangent(patch.reference());
  const Eigen::Vector4i thickness(5, 11, 17, 23);
  const Eigen::MatrixXd mixed = modes.transpose() * k(Eigen::all, thickness);
  const Eigen::Matrix4d stiff = k(thickness, thickness);
  return modes.transpose() * k * modes - mixed * stiff.ldlt().solve(mixed.transpose());
}

/// Largest difference, of √(entry_ii entry_jj).
double difference(const Abd& ours, const Abd& reference) {
  double worst = 0.0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      worst = std::max(worst, std::abs(ours(i, j) - reference(i, j)) / std::sqrt(reference(i, i) * reference(j, j)));
  return worst;
}

TEST(Laminate, stiffness) {
  for (const Laminate& laminate : laminates()) {
    const Abd ours = element_abd(laminate.layers);
    verification::verify(laminate.name, "A, B, D: largest entry off, one element",
                         difference(ours, linear_thickness_abd(laminate.layers)), 0.0, 1e-9, kLinear, 1.0);
    verification::verify(laminate.name, "A, B, D: largest entry off, one element",
                         difference(ours, plane_stress_abd(laminate.layers)), 0.0, 0.06, kClassical, 1.0);
  }
}

/// A strip pulled at its ends by N₁ alone, free to twist. @returns κ₁₂ per N₁
double twist_of_pulled_strip(const std::vector<tire::ShellLayer>& layers, int n, int m) {
  const double length = 1.0, width = 0.2;
  const ShellPatch strip(plate_mesh(n, m, length, width), layers);
  const int end = n * (m + 1);
  Vector load = Vector::Zero(strip.coordinates());
  for (int j = 0; j <= m; ++j) {
    const double share = width / m * (j == 0 || j == m ? 0.5 : 1.0);
    load[6 * j] = -share, load[6 * (end + j)] = share;
  }
  const Supports held = Supports(strip.nodes()).fix({0}, "xyz").fix({m}, "xz").fix({end}, "z");
  const Vector u = linear_solution(strip, held, load);
  const auto w = [&](int node) { return u[6 * node + 2]; };
  return -2 * (w(end + m) - w(end) - w(m) + w(0)) / (length * width);
}

TEST(Laminate, extension_twist_coupling) {
  const std::vector<tire::ShellLayer> layers = layup({45, -45}, 0.01);
  const Vector pull = Eigen::Matrix<double, 6, 1>::Unit(0);
  for (const int n : {1, 8})
    for (const bool plane : {false, true}) {
      const Abd abd = plane ? plane_stress_abd(layers) : linear_thickness_abd(layers);
      const double reference = abd.ldlt().solve(pull)[5], ours = twist_of_pulled_strip(layers, n, n);
      verification::verify("laminate [45/-45] pulled",
                           "twist per pull, 1/N, " + std::to_string(n) + " x " + std::to_string(n), ours, reference,
                           plane ? 0.01 : 1e-9, plane ? kClassical : kLinear);
    }
}

/// Central deflection relative to the closed form under the same load.
double plate_deflection(const std::vector<tire::ShellLayer>& layers, int n) {
  const double k = std::numbers::pi;
  const ShellPatch plate(plate_mesh(n, n, 1.0, 1.0), layers);
  const PatchMesh& mesh = plate.mesh();
  const auto at = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  Supports supports(plate.nodes());
  supports.fix(mesh.select([&](const Vec3& x) { return at(x.x(), 0) || at(x.x(), 1); }), "yzb");
  supports.fix(mesh.select([&](const Vec3& x) { return at(x.y(), 0) || at(x.y(), 1); }), "xza");
  Vector load = Vector::Zero(plate.coordinates());
  const double g = tire::kGaussPoint;
  for (const auto& e : mesh.elements)
    for (const double xi : {-g, g})
      for (const double eta : {-g, g}) {
        const double shape[4] = {(1 - xi) * (1 - eta) / 4, (1 + xi) * (1 - eta) / 4, (1 + xi) * (1 + eta) / 4,
                                 (1 - xi) * (1 + eta) / 4};
        Vec3 x = Vec3::Zero();
        for (int c = 0; c < 4; ++c) x += shape[c] * mesh.position[e[c]];
        for (int c = 0; c < 4; ++c)
          load[6 * e[c] + 2] += 0.25 / (n * n) * shape[c] * std::sin(k * x.x()) * std::sin(k * x.y());
      }
  return linear_solution(plate, supports, load)[6 * mesh.nearest({0.5, 0.5, 0}) + 2];
}

TEST(Laminate, simply_supported_cross_ply_plates) {
  const char* source = "Navier solution, first-order theory, factor 1 (Reddy 2004, sec. 7.3)";
  for (const auto& angles : {std::vector<double>{0, 90}, std::vector<double>{0, 90, 0}})
    for (const double slenderness : {10.0, 100.0}) {
      const std::vector<tire::ShellLayer> layers = layup(angles, 1.0 / slenderness);
      const std::string name = std::string("plate ") + (angles.size() == 2 ? "[0/90]" : "[0/90/0]") +
                               ", a/h = " + verification::brief(slenderness);
      const auto closed = [&](const Abd& abd, double factor) {
        return navier_deflection(abd, shear_stiffness(layers), factor, 1.0, 1.0);
      };
      for (const int n : {8, 16, 32}) {
        const double ours = plate_deflection(layers, n);
        const std::string quantity =
            "central deflection per load, m/Pa, " + std::to_string(n) + " x " + std::to_string(n);
        verification::verify(name, quantity, ours, closed(linear_thickness_abd(layers), 1.0), 1.0 / (n * n),
                             std::string(source) + ", " + kLinear);
        if (n == 32) {
          verification::verify(name, quantity, ours, closed(plane_stress_abd(layers), 1.0), 0.02, source);
          verification::verify(name, quantity, ours, closed(plane_stress_abd(layers), 5.0 / 6.0),
                               slenderness > 50 ? 0.02 : 0.15, "Navier solution, first-order theory, factor 5/6");
        }
      }
    }
}

}  // namespace
}  // namespace furrow::test
