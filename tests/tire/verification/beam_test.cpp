// Strips as beams: extension, bending, twist, the elastica, and a strip rolled up into a circle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tests/tire/verification/curves.hpp"
#include "tests/tire/verification/mesh_size.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using std::numbers::pi;
using verification::verify;

/// Inner nodes of a strip moved along it by ± share of an element, alternating across: trapezoids.
PatchMesh trapezoids(PatchMesh mesh, int n, double length, double share) {
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < 2; ++j) mesh.position[2 * i + j].x() += ((i + j) % 2 == 0 ? share : -share) * length / n;
  return mesh;
}

TEST(Beam, large_extension) {
  // S₁₁ = E E₁₁ with free sides: F/A = E λ (λ² − 1)/2.
  const double young = 1e7, stretch = 1.2, area = 0.1 * 0.01;
  const ShellPatch strip(trapezoids(plate_mesh(4, 1, 1.0, 0.1), 4, 1.0, 0.25), {isotropic_layer(0.01, young, 0.45)});
  Supports supports(strip.nodes());
  supports.fix({0, 1, 8, 9}, "xz").fix({0}, "y");
  StaticPath path(strip, supports, Vector::Zero(strip.coordinates()));
  path.prescribe([&](double share, Vector& q) {
    for (const int n : {8, 9}) q[6 * n] = 1.0 + share * (stretch - 1.0);
  });
  ASSERT_TRUE(path.go_to(1.0));
  const Vector r = path.reactions();
  verification::verify("strip pulled to 1.2 times its length", "force, N, 4 trapezoids", r[6 * 8] + r[6 * 9],
                       0.5 * young * area * stretch * (stretch * stretch - 1), 1e-9,
                       "F = E A (s^3 - s)/2, linear material of Green-Lagrange strain");
}

TEST(Beam, cantilever_under_an_end_force) {
  // F L³/(3 E I) + F L/(G A), shear correction factor 1
  for (const double height : {0.05, 0.005, 0.0005}) {
    const double inertia = 0.1 * std::pow(height, 3) / 12, force = 1e-6 * 2e7 * inertia;
    const double theory = 1e-6 / 3 + force / (1e7 * 0.1 * height);
    for (const double distortion : {0.0, 0.25})
      for (const int n : {4, 8, 16, 32}) {
        const ShellPatch strip(trapezoids(plate_mesh(n, 1, 1.0, 0.1), n, 1.0, distortion),
                               {isotropic_layer(height, 2e7, 0.0)});
        Vector load = Vector::Zero(strip.coordinates());
        load[6 * 2 * n + 2] = load[6 * (2 * n + 1) + 2] = 0.5 * force;
        const Vector u = linear_solution(strip, Supports(strip.nodes()).fix({0, 1}, "xyzab"), load);
        verification::verify("cantilever, end force, L/h = " + verification::brief(1 / height),
                             "tip deflection, m, " + size(n, 1) + (distortion > 0 ? " trapezoids" : ""),
                             u[6 * 2 * n + 2], theory, (distortion > 0 ? 1.6 : 0.5) / (n * n),
                             "Timoshenko beam, factor 1");
      }
  }
}

TEST(Beam, cantilever_under_an_end_moment) {
  // M L²/(2 E I), and −ν times that curvature across; the clamp leaves width and thickness free.
  const int n = 4, m = 4;
  for (const double height : {0.05, 0.005, 0.0005}) {
    const double moment = 1e-6 * 2e7 * 0.1 * std::pow(height, 3) / 12;
    const ShellPatch strip(plate_mesh(n, m, 1.0, 0.1), {isotropic_layer(height, 2e7, 0.45)});
    std::vector<int> clamp;
    Vector load = Vector::Zero(strip.coordinates());
    const int tip = n * (m + 1);
    for (int j = 0; j <= m; ++j) {
      clamp.push_back(j);
      load[6 * (tip + j) + 3] = -moment / m * (j == 0 || j == m ? 0.5 : 1.0);
    }
    const Vector u = linear_solution(strip, Supports(strip.nodes()).fix(clamp, "xa").fix({m / 2}, "yzb"), load);
    const std::string name = "cantilever, end moment, nu = 0.45, L/h = " + verification::brief(1 / height);
    verification::verify(name, "tip deflection, m, " + size(n, m), u[6 * (tip + m / 2) + 2], 0.5e-6, 1e-5,
                         "M L^2/(2 E I)");
    verification::verify(name, "rise of the edge over the middle, m, " + size(n, m),
                         u[6 * (tip + m / 2) + 2] - u[6 * tip + 2], 0.45 * 0.5e-6 * 0.05 * 0.05, 1e-4,
                         "nu kappa b^2/8");
  }
}

TEST(Beam, twist_of_a_strip) {
  // Reissner–Mindlin torsion of a strip b × h: u = z ψ(y), ψ″ h²/12 = k (ψ + θ′ y), ψ′ = θ′ at the edges, gives
  //   T/θ′ = G h³ b/3 [1 − tanh(x)/x],  x = √(3 k) b/h;  k = 5/6 would be Saint-Venant's within 1e-3.
  const double young = 2e7, shear = young / 2.6, b = 0.1, h = 0.01, length = 0.4, twist = 1e-4;  // rad
  const double x = std::sqrt(3.0) * b / h,
               mindlin = shear * h * h * h * b / 3 * (1 - std::tanh(x) / x) * twist / length,
               venant = shear * h * h * h * b / 3 * (1 - 0.630249 * h / b) * twist / length;
  for (const int m : {2, 8, 16, 32, 64}) {
    const ShellPatch strip(plate_mesh(4, m, length, b), {isotropic_layer(h, young, 0.3)});
    std::vector<int> ends;
    for (int j = 0; j <= m; ++j) ends.push_back(j), ends.push_back(4 * (m + 1) + j);
    Supports supports(strip.nodes());
    supports.fix(ends, "yzb").fix({0}, "x");
    StaticPath path(strip, supports, Vector::Zero(strip.coordinates()));
    path.prescribe([&](double share, Vector& q) {
      for (int j = 0; j <= m; ++j) {
        const int n = 4 * (m + 1) + j;
        q[6 * n + 2] = share * twist * (b * j / m - 0.5 * b);
        q[6 * n + 4] = -share * twist;
      }
    });
    ASSERT_TRUE(path.go_to(1.0));
    const Vector r = path.reactions();
    double torque = 0.0;
    for (int j = 0; j <= m; ++j) {
      const int n = 4 * (m + 1) + j;
      torque += (b * j / m - 0.5 * b) * r[6 * n + 2] - r[6 * n + 4];
    }
    verification::verify("twist of a strip, b/h = 10", "torque, N m, " + size(4, m), torque, mindlin,
                         std::min(0.06, 0.25 / m), "Reissner-Mindlin strip, factor 1");
    if (m == 64)
      verification::verify("twist of a strip, b/h = 10", "torque, N m, " + size(4, m), torque, venant, 0.01,
                           "Saint-Venant torsion (Timoshenko & Goodier, sec. 109)");
  }
}

/// Deflection and shortening of a cantilever of length 1 under α = P L²/(E I), from elliptic integrals.
///   Bisshopp & Drucker (1945), Large deflection of cantilever beams, Q. Appl. Math. 3, doi:10.1090/qam/13360.
std::pair<double, double> elastica(double alpha) {
  const auto load = [](double tip) {  // √α as a function of the tip's slope
    const double k = std::sqrt(0.5 * (1 + std::sin(tip))), phi = std::asin(std::sqrt(0.5) / k);
    return std::comp_ellint_1(k) - std::ellint_1(k, phi);
  };
  double low = 0.0, high = 0.5 * pi - 1e-12;
  for (int n = 0; n < 200; ++n) {
    const double middle = 0.5 * (low + high);
    (load(middle) < std::sqrt(alpha) ? low : high) = middle;
  }
  const double k = std::sqrt(0.5 * (1 + std::sin(low))), phi = std::asin(std::sqrt(0.5) / k);
  return {1 - 2 * (std::comp_ellint_2(k) - std::ellint_2(k, phi)) / std::sqrt(alpha),
          1 - std::sqrt(2 * std::sin(low) / alpha)};
}

TEST(Beam, elastica) {
  // Sze, Liu & Lo (2004), § 3.1: L = 10, b = 1, h = 0.1, E = 1.2e6, ν = 0, P = 4 E I/L².
  const char* paper = "Sze, Liu & Lo 2004 doi:10.1016/j.finel.2003.11.001";
  const double table[4][3] = {{0.25, 0.563, 3.015}, {0.5, 1.604, 4.933}, {0.75, 2.541, 6.031}, {1.0, 3.286, 6.698}};
  for (const int n : {8, 16, 32}) {
    const ShellPatch strip(plate_mesh(n, 1, 10.0, 1.0), {isotropic_layer(0.1, 1.2e6, 0.0)});
    Vector load = Vector::Zero(strip.coordinates());
    load[6 * 2 * n + 2] = load[6 * (2 * n + 1) + 2] = 2.0;
    StaticPath path(strip, Supports(strip.nodes()).fix({0, 1}, "xyzabc"), load);
    verification::Worst tabulated("cantilever, large end force", "deflection or shortening, " + size(n, 1), 0.02,
                                  paper);
    verification::Worst exact("cantilever, large end force", "deflection or shortening, " + size(n, 1),
                              std::max(0.02 * (8.0 / n) * (8.0 / n), 2e-3),
                              "elastica, Bisshopp & Drucker 1945 doi:10.1090/qam/13360");
    for (const auto& [share, u, w] : table) {
      ASSERT_TRUE(path.go_to(share));
      const double shortening = 10 - path.q()[6 * 2 * n], deflection = path.q()[6 * 2 * n + 2];
      const auto [w0, u0] = elastica(4 * share);
      const std::string where = "P/Pmax = " + verification::brief(share);
      tabulated.add(shortening, u, 6.698, where), tabulated.add(deflection, w, 6.698, where);
      exact.add(shortening, 10 * u0, 6.698, where), exact.add(deflection, 10 * w0, 6.698, where);
      verification::curve_point("cantilever, end force", "deflection, " + size(n, 1), share, deflection, w);
      verification::curve_point("cantilever, end force", "shortening, " + size(n, 1), share, shortening, u);
    }
  }
}

TEST(Beam, strip_rolled_up_into_a_full_circle) {
  // Sze, Liu & Lo (2004), § 3.2: L = 12, b = 1, h = 0.1, E = 1.2e6, ν = 0; M = 2π E I/L closes the circle. The end's
  // direction is prescribed; its position is free, so the reaction is a pure moment.
  const double length = 12.0, stiffness = 1.2e6 * 1e-3 / 12;
  for (const int n : {8, 16, 32}) {
    const ShellPatch strip(plate_mesh(n, 1, length, 1.0), {isotropic_layer(0.1, 1.2e6, 0.0)});
    const int tip = 2 * n;
    StaticPath path(strip, Supports(strip.nodes()).fix({0, 1}, "xyzabc").fix({tip, tip + 1}, "abc"),
                    Vector::Zero(strip.coordinates()));
    path.prescribe([&](double share, Vector& q) {
      for (const int node : {tip, tip + 1})
        q.segment<3>(6 * node + 3) << -std::sin(2 * pi * share), 0, std::cos(2 * pi * share);
    });
    const double tolerance = std::max(8.0 / (n * n), 9e-3);
    verification::Worst moment("strip rolled up by an end moment", "moment, N m, " + size(n, 1), tolerance,
                               "M = E I kappa"),
        place("strip rolled up by an end moment", "tip position, of the length, " + size(n, 1), tolerance,
              "circular arc");
    for (int part = 1; part <= 24; ++part) {
      const double angle = 2 * pi * part / 24;
      ASSERT_TRUE(path.go_to(part / 24.0));
      const Vector r = path.reactions(), &q = path.q();
      double m = 0.0;  // about −y: d × Q
      for (const int node : {tip, tip + 1}) m += q[6 * node + 3] * r[6 * node + 5] - q[6 * node + 5] * r[6 * node + 3];
      const std::string where = verification::brief(part * 15) + " deg";
      moment.add(m, stiffness * angle / length, stiffness * 2 * pi / length, where);
      place.add(q[6 * tip], length * std::sin(angle) / angle, length, where);
      place.add(q[6 * tip + 2], length * (1 - std::cos(angle)) / angle, length, where);
      verification::curve_point("strip rolled up", "moment over 2 pi E I/L, " + size(n, 1), part / 24.0,
                                m * length / (2 * pi * stiffness), part / 24.0);
    }
  }
}

}  // namespace
}  // namespace furrow::test
