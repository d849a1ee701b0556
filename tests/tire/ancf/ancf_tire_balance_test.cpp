// Momentum, angular momentum and energy of the whole layered tire over single intervals of a rolling contact.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "protocol/core/mean_turn.hpp"
#include "small_tire.hpp"

namespace furrow::test {
namespace {

constexpr double kStep = 1e-4, kSpeed = 8.0;

/// M (0, 0, −g): consistent, so directors have a share.
tire::Field consistent_weight(const tire::AncfTire& tire) {
  const tire::ShellLayout& layout = tire.integrator().layout();
  tire::Field down(layout.size(), 0.0), weight(layout.size(), 0.0);
  for (int j = 0; j < layout.rows; ++j)
    for (int i = 0; i < layout.columns; ++i) layout.set(down, i, j, 0, Vec3(0, 0, -9.81));
  layout.fill_padding(down);
  tire.integrator().mass().apply(down, 1.0, weight);
  return weight;
}

TEST(AncfTireBalance, momentum_and_angular_momentum_change_by_contact_gravity_and_spindle_impulse_to_round_off) {
  Rolling rolling(small_file());
  const tire::AncfTire& tire = rolling.tire;
  const tire::RimTrajectory& t = rolling.path;
  const tire::ShellLayout& layout = tire.integrator().layout();
  const tire::Field weight = consistent_weight(tire);
  for (int n = 0; n < 250; ++n) {
    const auto [p, l] = momenta(tire);
    const tire::Field before = tire.integrator().q();
    const SurfaceState start = rolling.surface();
    NodalForces f = ground_forces(tire);
    if (n % 7 == 0) {  // a force on a bead disc, too
      f.vertex.push_back(tire.mesh().vertex_count - 1);
      f.force.push_back(Vec3(3, -20, 8));
    }
    rolling.go(rolling.at(n), kStep, f);
    const SurfaceState end = rolling.surface();
    const tire::Field& after = tire.integrator().q();
    const Wrench spindle = tire.spindle_wrench();
    const Vec3 centre = 0.5 * (t.start().position + t.end().position);
    Vec3 force = -spindle.force, moment = -spindle.moment - centre.cross(spindle.force);
    double scale = spindle.force.norm();
    for (int j = 0; j < layout.rows; ++j)
      for (int i = 0; i < layout.columns; ++i) {
        force += layout.get(weight, i, j, 0);
        for (const int s : {0, 3})
          moment +=
              (0.5 * (layout.get(before, i, j, s) + layout.get(after, i, j, s))).cross(layout.get(weight, i, j, s));
      }
    scale += 9.81 * tire.mass_properties().mass;
    for (std::size_t k = 0; k < f.vertex.size(); ++k) {
      force += f.force[k];
      moment += (0.5 * (start.position[f.vertex[k]] + end.position[f.vertex[k]])).cross(f.force[k]);
      scale += f.force[k].norm();
    }
    const auto [p1, l1] = momenta(tire);
    EXPECT_LT(((p1 - p) / kStep - force).norm(), 1e-10 * scale) << "interval " << n;
    EXPECT_LT(((l1 - l) / kStep - moment).norm(), 1e-10 * scale) << "interval " << n;  // arms are below 1 m
  }
}

/// Energies of a tire over 0.04 s of rolling on a ground.
struct RolledEnergy {
  double work = 0.0;    // of rim and ground, J
  double stored = 0.0;  // J
  tire::TireDiagnostics end;
  explicit RolledEnergy(double h) {
    Rolling rolling(small_file());
    rolling.step = h;
    const tire::AncfTire& tire = rolling.tire;
    const tire::TireDiagnostics start = tire.diagnostics();
    double dissipation = 0.0;
    const int steps = static_cast<int>(std::lround(0.04 / h));
    for (int n = 0; n < steps; ++n) {
      const NodalForces f = ground_forces(tire);
      const SurfaceState before = rolling.surface();
      rolling.go(rolling.at(n), h, f);
      work += surface_work(f, before, rolling.surface()) + rim_work(tire, rolling.path);
      EXPECT_GE(tire.diagnostics().dissipation, dissipation);
      dissipation = tire.diagnostics().dissipation;
    }
    end = tire.diagnostics();
    stored = end.stored() - start.stored();
  }
  double left_over() const { return work - stored - end.losses(); }
};

TEST(AncfTireBalance, energy_closes_to_second_order_of_the_step_with_the_numerical_loss_booked_by_itself) {
  const RolledEnergy coarse(2e-4), fine(1e-4);
  EXPECT_GT(fine.end.dissipation, 0.1);  // J
  EXPECT_GT(fine.end.numerical_loss, 0.0);
  EXPECT_LT(fine.end.numerical_loss, 0.7 * coarse.end.numerical_loss);  // of first order
  EXPECT_LT(std::abs(fine.left_over()), 1e-4 * fine.end.dissipation);
  EXPECT_LT(std::abs(fine.left_over()), 0.4 * std::abs(coarse.left_over()) + 1e-9 * fine.end.dissipation)
      << coarse.left_over() << " and " << fine.left_over() << " J";
  std::printf("viscous %.4g, numerical %.4g and %.4g, solver %.2g and %.2g, left over %.2g and %.2g J\n",
              fine.end.dissipation, coarse.end.numerical_loss, fine.end.numerical_loss, coarse.end.solver_loss,
              fine.end.solver_loss, coarse.left_over(), fine.left_over());
}

/// Each free node loses ½ m |Δv|² = ½ m (ω² r h)² and gets it back through the moment; so a steady spin loses nothing.
TEST(AncfTireBalance, steady_spin_loses_nothing_to_the_time_integration) {
  tire::ShellIntegratorParams weightless;
  weightless.gravity.setZero();
  const auto rim_at = [&](double t) {
    RimState rim;
    rim.angular_velocity = Vec3(0.0, kSpeed, 0.0);
    rim.orientation = Quat(Eigen::AngleAxisd(kSpeed * t, Vec3::UnitY()));
    return rim;
  };
  LedTire led(rim_at(0.0), small_file(), weightless);
  const tire::AncfTire& tire = led.tire;
  double before = 0.0;
  const int settling = 2000, steps = 500;
  for (int n = 0; n < settling + steps; ++n) {
    if (n == settling) before = tire.diagnostics().numerical_loss;
    led.go(rim_at(n * kStep), kStep);
  }
  const double change = kSpeed * kStep, inertia = tire.mass_properties().inertia(1, 1);
  const double of_free_nodes = 0.5 * inertia * kSpeed * kSpeed * change * change * steps;
  EXPECT_LT(std::abs(tire.diagnostics().numerical_loss - before), 0.05 * of_free_nodes);
}

}  // namespace
}  // namespace furrow::test
