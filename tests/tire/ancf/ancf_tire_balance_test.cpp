// Momentum, angular momentum and energy of the whole layered tire over single intervals of a rolling contact.
#include <gtest/gtest.h>

#include "small_tire.hpp"

namespace furrow::test {
namespace {

constexpr double kStep = 1e-4, kSpeed = 8.0, kDepth = 0.008;

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

TEST(AncfTireBalance,
     momentum_and_angular_momentum_change_by_contact_gravity_and_spindle_impulse_to_round_off) {
  tire::AncfTire tire(small_file());
  const tire::ShellLayout& layout = tire.integrator().layout();
  const tire::Field weight = consistent_weight(tire);
  const RimState rim = rolling_rim(0, tire.radius(), kSpeed, kDepth);
  tire.place(rim);
  tire::RimTrajectory t(rim);
  SurfaceState start, end;
  for (int n = 0; n < 250; ++n) {
    const auto [p, l] = momenta(tire);
    const tire::Field before = tire.integrator().q();
    tire.surface(start);
    NodalForces f = ground_forces(tire);
    if (n % 7 == 0) {  // something on a bead disc too
      f.vertex.push_back(tire.mesh().vertex_count - 1);
      f.force.push_back(Vec3(3, -20, 8));
    }
    t.extend(rolling_rim(n * kStep, tire.radius(), kSpeed, kDepth), kStep);
    const Outcome status = tire.advance(t, f, 1);
    ASSERT_TRUE(status.ok) << status.message("tire");
    tire.surface(end);
    const tire::Field& after = tire.integrator().q();
    const Wrench spindle = tire.spindle_wrench();
    const Vec3 centre = 0.5 * (t.start().position + t.end().position);
    Vec3 force = -spindle.force, moment = -spindle.moment - centre.cross(spindle.force);
    double scale = spindle.force.norm();
    for (int j = 0; j < layout.rows; ++j)
      for (int i = 0; i < layout.columns; ++i) {
        force += layout.get(weight, i, j, 0);
        for (const int s : {0, 3})
          moment += (0.5 * (layout.get(before, i, j, s) + layout.get(after, i, j, s)))
                        .cross(layout.get(weight, i, j, s));
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

TEST(AncfTireBalance, dissipation_grows_and_energy_does_not_appear_from_nothing) {
  tire::AncfTire tire(small_file());
  RimState rim = rolling_rim(0, tire.radius(), kSpeed, kDepth);
  tire.place(rim);
  tire::RimTrajectory t(rim);
  const tire::TireDiagnostics start = tire.diagnostics();
  double work = 0.0, dissipation = 0.0;
  SurfaceState before, after;
  for (int n = 0; n < 400; ++n) {
    const NodalForces f = ground_forces(tire);
    tire.surface(before);
    const RimState from = t.end();
    t.extend(rolling_rim(n * kStep, tire.radius(), kSpeed, kDepth), kStep);
    ASSERT_TRUE(tire.advance(t, f, 1).ok);
    tire.surface(after);
    for (std::size_t k = 0; k < f.vertex.size(); ++k)
      work += f.force[k].dot(after.position[f.vertex[k]] - before.position[f.vertex[k]]);
    const Wrench w = tire.spindle_wrench();
    work -= w.force.dot(t.end().position - from.position) +
            w.moment.dot(0.5 * kStep * (t.end().angular_velocity + from.angular_velocity));
    work += tire.mass_properties().mass * -9.81 * (t.end().position.z() - from.position.z());
    const tire::TireDiagnostics d = tire.diagnostics();
    EXPECT_GE(d.dissipation, dissipation);
    dissipation = d.dissipation;
  }
  const tire::TireDiagnostics end = tire.diagnostics();
  const double stored = end.kinetic_energy + end.strain_energy - start.kinetic_energy - start.strain_energy;
  EXPECT_GT(dissipation, 0.1);  // J
  EXPECT_LE(stored + dissipation, work + 0.02 * dissipation);
  EXPECT_NEAR(stored + dissipation, work,
              0.06 * (dissipation + std::abs(stored)));  // numerical damping of order h/τ
}

}  // namespace
}  // namespace furrow::test
