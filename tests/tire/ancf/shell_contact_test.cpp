// Contact forces that follow the tire's motion: stability above the stable step of late forces, restart, equilibrium.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "small_tire.hpp"
#include "tests/saved.hpp"

namespace furrow::test {
namespace {

constexpr double kStiffness = 4e5, kDamping = 20.0;  // of the ground under each vertex, N/m, N s/m

/// Springs and dashpots at z = 0 that act on the vertices like a terrain, one interval late.
class Springs {
 public:
  explicit Springs(const tire::Tire& tire) {
    SurfaceState s;
    tire.surface(s);
    at_ = s.position;
  }
  NodalForces forces(const tire::Tire& tire, double h, bool tangents) {
    SurfaceState s;
    tire.surface(s);
    NodalForces f;
    for (int k = 0; k < tire.mesh().vertex_count; ++k) {
      const Vec3 end = s.position[k] + h * s.velocity[k];
      ContactTangent t;
      t.position = 0.5 * (at_[k] + end);
      t.velocity = (end - at_[k]) / h;
      at_[k] = end;
      const double force = -kStiffness * t.position.z() - kDamping * t.velocity.z();
      if (t.position.z() >= 0.0 || force <= 0.0) continue;
      t.stiffness(2, 2) = kStiffness;
      t.damping(2, 2) = kDamping;
      f.vertex.push_back(k);
      f.force.emplace_back(0.0, 0.0, force);
      if (tangents) f.tangent.push_back(t);
    }
    return f;
  }

 private:
  std::vector<Vec3> at_;  // m
};

tire::TireFile limp_file() {
  tire::TireFile file = small_file("hmmwv_layered.json", 48, 12);
  file.structural_damping = 5e-4;
  return file;
}

/// Presses a tire on springs and holds it. @returns the largest change of the spindle's force from one interval to the
/// next over the last quarter, N; infinite if it did not converge
double unrest(bool tangents, double h, double& load, double time = 0.04) {
  Rolling rolling(limp_file(), {}, 0.0, 0.010);
  rolling.step = h;
  const tire::AncfTire& tire = rolling.tire;
  Springs springs(tire);
  NodalForces f;
  double most = 0.0;
  const int steps = static_cast<int>(time / h);
  for (int n = 0; n < steps; ++n) {
    const NodalForces next = springs.forces(tire, h, tangents);
    if (!rolling.advance(rolling.at(n), h, f).ok) return INFINITY;
    f = next;
    const double force = tire.spindle_wrench().force.z();
    if (n >= 3 * steps / 4) most = std::max(most, std::abs(force - load));
    load = force;
  }
  return most;
}

TEST(ShellContact, holds_a_tire_at_rest_at_a_step_at_which_late_forces_throw_it) {
  double load = 0.0, thrown = 0.0;
  const double calm = unrest(true, 4e-4, load, 0.1), wild = unrest(false, 4e-4, thrown);
  EXPECT_GT(load, 1000.0);
  EXPECT_LT(calm, 0.05 * load);
  EXPECT_GT(wild, load);
}

TEST(ShellContact, comes_to_the_load_of_small_steps_without_it) {
  double late = 0.0, answering = 0.0;
  unrest(false, 4e-5, late);
  unrest(true, 4e-5, answering);
  EXPECT_NEAR(answering / late, 1.0, 0.01);
}

TEST(ShellContact, never_pulls_and_keeps_what_acted) {
  LedTire led({}, small_file());
  const int vertex = led.tire.integrator().layout().rows / 2;  // lies still
  NodalForces f{{vertex}, {Vec3(0, 0, 100.0)}, {{}}};
  const SurfaceState s = led.surface();
  f.tangent[0].stiffness = 1e5 * Mat3::Identity();
  for (const double deeper : {0.0, -0.5e-3, 2e-3, 1.0}) {
    f.tangent[0].position = s.position[vertex] - Vec3(0, 0, deeper);
    led.path = tire::RimTrajectory();
    led.tire.place({});
    NodalForces acted = f;
    led.go({}, 1e-6, acted);
    led.tire.acted(acted);
    EXPECT_NEAR(acted.force[0].z(), std::max(0.0, 100.0 - 1e5 * deeper), 0.1) << deeper;
    EXPECT_NEAR(acted.force[0].head<2>().norm(), 0.0, 0.1);
  }
}

TEST(ShellContact, momentum_of_the_tire_changes_by_what_acted) {
  Rolling rolling(small_file());
  const double h = rolling.step = 2e-4;
  const tire::AncfTire& tire = rolling.tire;
  Springs springs(tire);
  NodalForces f;
  const double mass = tire.mass_properties().mass;
  double pushed = 0.0;
  for (int n = 0; n < 150; ++n) {
    const NodalForces next = springs.forces(tire, h, true);
    const Vec3 before = momenta(tire).first;
    rolling.go(rolling.at(n), h, f, 2);
    tire.acted(f);
    Vec3 impulse = h * (Vec3(0, 0, -9.81 * mass) - tire.spindle_wrench().force);
    for (const Vec3& force : f.force) impulse += h * force, pushed += h * force.z();
    EXPECT_LE((momenta(tire).first - before - impulse).norm(), 1e-10);
    f = next;
  }
  EXPECT_GT(pushed, 1.0);
}

TEST(ShellContact, a_restored_tire_continues_bit_for_bit) {
  struct Ride : Rolling {
    Springs springs{tire};
    NodalForces forces;
    using Rolling::Rolling;
    void advance(int n) {
      const NodalForces next = springs.forces(tire, step, true);
      go(at(n), step, forces);
      forces = next;
    }
  };
  Ride one(small_file()), other(small_file());
  one.step = other.step = 2e-4;
  for (int n = 0; n < 100; ++n) one.advance(n);
  const Archive archive = testing::saved(one.tire);
  EXPECT_TRUE(archive.has("ancf/factor/contact"));
  other.tire.restore(archive);
  other.path = one.path, other.springs = one.springs, other.forces = one.forces;
  for (int n = 100; n < 160; ++n) one.advance(n), other.advance(n);
  EXPECT_EQ(one.tire.integrator().q(), other.tire.integrator().q());
  EXPECT_EQ(one.tire.integrator().v(), other.tire.integrator().v());
  EXPECT_EQ(one.tire.figures().of("newton_iterations"), other.tire.figures().of("newton_iterations"));
}

}  // namespace
}  // namespace furrow::test
