// Plate frequencies, and motion in time: a flexible pendulum, a strip in free flight, a tire on a swinging rim.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/mesh_size.hpp"
#include "tests/verification/record.hpp"
#include "tire/ancf/inflation.hpp"

namespace furrow::test {
namespace {

using std::numbers::pi;
using verification::verify;

/// ω a² √(ρ h/D) of the lowest bending modes of a unit square plate. In-plane motion is held: it does not couple.
Vector plate_frequencies(double height, Supports& supports, const PatchMesh& mesh, int count) {
  const double young = 1e9, poisson = 0.3, density = 1000.0;
  const ShellPatch plate(mesh, {isotropic_layer(height, young, poisson)});
  for (int node = 0; node < plate.nodes(); ++node) supports.fix({node}, "xyc");
  const std::vector<int> free = supports.free();
  const Vector squares = lowest_eigenvalues(restrict_to(plate.tangent(plate.reference()), free),
                                            restrict_to(plate.mass(density), free), count);
  const double d = young * std::pow(height, 3) / (12 * (1 - poisson * poisson));
  return (squares.array() * density * height / d).sqrt();
}

TEST(Dynamics, frequencies_of_a_simply_supported_plate) {
  // Kirchhoff: λ = π² (m² + n²).
  const double theory[5] = {2, 5, 5, 8, 10};
  for (const double height : {0.01, 0.001})
    for (const int n : {8, 16, 32}) {
      const PatchMesh mesh = plate_mesh(n, n, 1.0, 1.0);
      const auto at = [](double a) { return std::abs(a) < 1e-9 || std::abs(a - 1) < 1e-9; };
      Supports supports(mesh.nodes());
      supports.fix(mesh.select([&](const Vec3& x) { return at(x.x()); }), "zb");
      supports.fix(mesh.select([&](const Vec3& x) { return at(x.y()); }), "za");
      const Vector ours = plate_frequencies(height, supports, mesh, 5);
      for (int mode = 0; mode < 5; ++mode)
        if (mode != 2)
          verification::verify("simply supported square plate, a/h = " + verification::brief(1 / height),
                               "frequency " + std::to_string(mode + 1) + ", omega a^2 sqrt(rho h/D), " + size(n, n),
                               ours[mode], pi * pi * theory[mode], 12.0 / (n * n) + 2e-3, "pi^2 (m^2 + n^2)");
    }
}

TEST(Dynamics, frequencies_of_a_cantilever_plate) {
  // Leissa's are Ritz values, upper bounds by up to half a per cent.
  const double leissa[6] = {3.4917, 8.5246, 21.429, 27.331, 31.111, 54.443};
  for (const int n : {8, 16, 32}) {
    const PatchMesh mesh = plate_mesh(n, n, 1.0, 1.0);
    Supports supports(mesh.nodes());
    supports.fix(mesh.select([](const Vec3& x) { return std::abs(x.x()) < 1e-9; }), "zab");
    const Vector ours = plate_frequencies(0.005, supports, mesh, 6);
    for (int mode = 0; mode < 6; ++mode)
      verification::verify("cantilever square plate, a/h = 200",
                           "frequency " + std::to_string(mode + 1) + ", omega a^2 sqrt(rho h/D), " + size(n, n),
                           ours[mode], leissa[mode], 6.0 / (n * n) + 7e-3,
                           "Leissa 1973 doi:10.1016/S0022-460X(73)80371-2 (Ritz)");
  }
}

// --- time integration of a strip: forces at the middle of the step as in the tire's integrator

/// q' − q = h [θ v' + (1 − θ) v]: θ = ½ is the energy-momentum rule, θ = 1 the tire's.
class Stepper {
 public:
  Stepper(const ShellPatch& patch, const Supports& supports, double density, double gravity, double theta)
      : patch_(patch), free_(supports.free()), mass_(patch.mass(density)), theta_(theta) {
    Vector down = Vector::Zero(patch.coordinates());
    for (int n = 0; n < patch.nodes(); ++n) down[6 * n + 2] = -gravity;
    weight_ = mass_ * down;
    q = patch.reference();
    v = Vector::Zero(q.size());
  }

  void step(double h) {
    const Vector q0 = q, v0 = v;
    const auto e0 = patch_.strains(q0);
    q = q0 + h * v0;
    for (int n = 0; n < 30; ++n) {
      v = (q - q0) / (theta_ * h) - (1 - theta_) / theta_ * v0;
      const Vector middle = 0.5 * (q0 + q);
      auto stress = patch_.strains(q);
      if (theta_ < 1)
        for (std::size_t e = 0; e < stress.size(); ++e) stress[e] = 0.5 * (stress[e] + e0[e]);
      stress = patch_.stresses(stress);
      const Vector r = mass_ * (v - v0) / h + patch_.forces(middle, stress) - weight_;
      // B(q_m) instead of B(q') keeps it symmetric.
      const double share = theta_ < 1 ? 0.5 : 1.0;
      const Sparse k = mass_ / (theta_ * h * h) + patch_.tangent(middle, stress, share, 0.5);
      const Sparse part = restrict_to(k, free_);
      if (solver_.rows() == 0) solver_.analyzePattern(part);
      solver_.factorize(part);
      const Vector change = solver_.solve(restrict_to(r, free_));
      for (std::size_t a = 0; a < free_.size(); ++a) q[free_[a]] -= change[static_cast<int>(a)];
      if (change.cwiseAbs().maxCoeff() < 1e-12) break;
    }
    v = (q - q0) / (theta_ * h) - (1 - theta_) / theta_ * v0;
    const Vector dv = v - v0;
    auto change = patch_.strains(q);
    for (std::size_t e = 0; e < change.size(); ++e) change[e] -= e0[e];
    const auto stress = patch_.stresses(change);
    double strain = 0.0;
    for (std::size_t e = 0; e < change.size(); ++e) strain += change[e].dot(stress[e]);
    if (theta_ == 1.0) removed += 0.5 * dv.dot(mass_ * dv) + 0.5 * strain;
  }

  double energy() const { return 0.5 * v.dot(mass_ * v) + patch_.energy(q) - weight_.dot(q); }
  Vec3 momentum() const {
    const Vector p = mass_ * v;
    Vec3 sum = Vec3::Zero();
    for (int n = 0; n < patch_.nodes(); ++n) sum += p.segment<3>(6 * n);
    return sum;
  }
  Vec3 angular_momentum() const {
    const Vector p = mass_ * v;
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 2 * patch_.nodes(); ++k) sum += q.segment<3>(3 * k).cross(p.segment<3>(3 * k));
    return sum;
  }

  Vector q, v;
  double removed = 0.0;  // by the scheme, J

 private:
  const ShellPatch& patch_;
  std::vector<int> free_;
  Sparse mass_;
  Eigen::SimplicialLDLT<Sparse> solver_;
  double theta_;
  Vector weight_;
};

ShellPatch rubber_strip() { return ShellPatch(plate_mesh(4, 1, 1.0, 0.1), {isotropic_layer(0.02, 5e6, 0.3)}); }

TEST(Dynamics, flexible_pendulum_through_large_rotations) {
  // Hinged at one end, released horizontally; after 0.5 s it has passed the vertical.
  const ShellPatch strip = rubber_strip();
  const Supports hinge = Supports(strip.nodes()).fix({0, 1}, "xyz");
  const double scale = 1100 * 0.1 * 0.02 * 9.81 * 0.5;  // m g L/2, J
  const char* names[2] = {"flexible pendulum, mid-point rule", "flexible pendulum, rule of the tire"};
  for (const bool ours : {false, true}) {
    Vec3 tip[3];
    double lost[3];
    const double steps[3] = {5e-4, 2.5e-4, 1.25e-4};
    for (int k = 0; k < 3; ++k) {
      Stepper run(strip, hinge, 1100, 9.81, ours ? 1.0 : 0.5);
      const double start = run.energy();
      const int count = static_cast<int>(std::lround(0.5 / steps[k]));
      for (int n = 0; n < count; ++n) run.step(steps[k]);
      tip[k] = run.q.segment<3>(6 * 9);
      lost[k] = start - run.energy();
      const std::string where = ", h = " + verification::brief(steps[k]) + " s, 4 x 1";
      if (!ours)
        verification::verify(names[0], "energy change over m g L/2" + where, lost[k] / scale, 0.0, 1e-9,
                             "conserved (Simo & Tarnow 1992 doi:10.1007/BF00913408)", 1.0);
      else
        verification::verify(names[1], "energy lost, J" + where, lost[k], run.removed, 1e-7,
                             "sum of dv M dv/2 + dE D dE/2 over the steps");
    }
    const double order = std::log2((tip[0] - tip[1]).norm() / (tip[1] - tip[2]).norm());
    verification::verify(names[ours], "order of the tip's position in the step, 4 x 1", order, ours ? 1.0 : 2.0, 0.15,
                         ours ? "first order: backward Euler velocities" : "second order");
    if (ours)
      verification::verify(names[1], "order of the energy lost in the step, 4 x 1", std::log2(lost[1] / lost[2]), 1.0,
                           0.15, "first order");
  }
}

TEST(Dynamics, free_flight_of_a_strip) {
  const ShellPatch strip = rubber_strip();
  for (const bool ours : {false, true}) {
    Stepper run(strip, Supports(strip.nodes()), 1100, 0.0, ours ? 1.0 : 0.5);
    const Vec3 spin(3, 20, -5), speed(4, -1, 2);
    for (int n = 0; n < strip.nodes(); ++n) {
      run.v.segment<3>(6 * n) = speed + spin.cross(run.q.segment<3>(6 * n)) * (1 + 0.5 * run.q[6 * n]);
      run.v.segment<3>(6 * n + 3) = spin.cross(run.q.segment<3>(6 * n + 3));
    }
    const Vec3 p = run.momentum(), l = run.angular_momentum();
    for (int n = 0; n < 300; ++n) run.step(1e-3);
    const std::string name = std::string("free flight with bending, ") + (ours ? "rule of the tire" : "mid-point rule");
    verification::verify(name, "momentum change after 300 steps, 4 x 1", (run.momentum() - p).norm(), 0.0, 1e-12,
                         "conserved", p.norm());
    if (!ours)
      verification::verify(name, "angular momentum change after 300 steps, 4 x 1", (run.angular_momentum() - l).norm(),
                           0.0, 1e-10, "conserved", l.norm());
  }
}

/// Angular impulse (N m s) on the rim about its pivot while the rim of the inflated toroidal tire swings for 0.06 s.
double swung_tire(double h) {
  tire::TireFile file = small_file("toroidal.json", 24, 8);
  const tire::ShellMesh mesh = tire::make_shell_mesh(file);
  tire::ShellIntegratorParams params;
  params.damping = file.structural_damping;
  params.tolerance = 1e-9;
  params.max_iterations = 400;
  tire::ShellIntegrator run(file, mesh, params);
  tire::InflationReport report;
  const tire::Field q = tire::inflate(run.shell(), mesh, report);
  // Swings by 60° about an axis along x, 1 m above, with a half sine of 0.1 s; starts and ends at rest.
  const auto rim = [](double t) {
    const double s = std::min(t / 0.1, 1.0), angle = pi / 3 * (s - std::sin(2 * pi * s) / (2 * pi)),
                 rate = s < 1 ? pi / 3 * (1 - std::cos(2 * pi * s)) / 0.1 : 0.0;
    RimState r;
    r.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitX()));
    r.angular_velocity = rate * Vec3::UnitX();
    r.position = Vec3(0, 0, 1) + r.orientation * Vec3(0, 0, -1);
    r.velocity = r.angular_velocity.cross(r.orientation * Vec3(0, 0, -1));
    return r;
  };
  run.start(q, tire::Field(q.size(), 0.0));
  const tire::Field none(q.size(), 0.0);
  Wrench on_rim;
  const int count = static_cast<int>(std::lround(0.06 / h));
  double torque = 0.0;
  for (int n = 1; n <= count; ++n) {
    const Outcome status = run.step(h, rim((n - 1) * h), rim(n * h), none, Vec3(0, 0, 1), on_rim);
    EXPECT_TRUE(status.ok) << status.message("tire");
    torque += h * on_rim.moment.x();
  }
  return torque;
}

TEST(Dynamics, tire_on_a_swinging_rim) {
  double impulse[4];
  const double steps[4] = {8e-4, 4e-4, 2e-4, 1e-4};
  for (int k = 0; k < 4; ++k) impulse[k] = swung_tire(steps[k]);
  const double limit = 2 * impulse[3] - impulse[2];
  const double order = std::log2((impulse[1] - impulse[2]) / (impulse[2] - impulse[3]));
  verification::verify("toroidal tire on a rim swinging through 60 deg",
                       "angular impulse on the rim, N m s, h = 1e-4 s, 24 x 8", impulse[3], limit, 5e-3,
                       "extrapolated in the step");
  verification::verify("toroidal tire on a rim swinging through 60 deg", "order in the step, 24 x 8",
                       std::max(order, 1.0) - order, 0.0, 0.2, "first order or better", 1.0);
}

}  // namespace
}  // namespace furrow::test
