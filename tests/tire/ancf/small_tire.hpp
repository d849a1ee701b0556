// A coarse layered tire and a ground to press it on, for the tests of the whole model.
#pragma once

#include <gtest/gtest.h>

#include "tests/saved.hpp"
#include "tests/tire/led_tire.hpp"
#include "tire/ancf/ancf_tire.hpp"
#include "tire/read_tire_file.hpp"

namespace furrow::test {

inline tire::TireFile small_file(const char* name = "hmmwv_layered.json", int columns = 24, int width = 6) {
  tire::TireFile file = tire::read_tire_file(std::string(TIRE_DATA "/") + name);
  file.elements_circumference = columns;
  tire::set_elements_width(file, width);
  return file;
}

/// Penalty springs at z = 0 with viscous friction, one interval late like any terrain.
inline NodalForces ground_forces(const tire::Tire& tire) {
  SurfaceState s;
  tire.surface(s);
  NodalForces f;
  for (int k = 0; k < tire.mesh().vertex_count; ++k) {
    const double depth = -s.position[k].z();
    if (depth <= 0.0) continue;
    const double normal = std::max(0.0, 2e5 * depth - 30.0 * s.velocity[k].z());
    f.vertex.push_back(k);
    f.force.push_back(Vec3(-20.0 * s.velocity[k].x(), -20.0 * s.velocity[k].y(), normal));
  }
  return f;
}

/// A rim that rolls at `speed` and moves down from just above the ground, smoothly in time.
inline RimState rolling_rim(double time, double radius, double speed, double depth) {
  RimState r;
  const double share = std::min(1.0, time / 0.02);
  r.position = Vec3(speed * radius * time, 0.0, radius - depth * share * share * (3 - 2 * share));
  r.velocity = Vec3(speed * radius, 0.0, share < 1.0 ? -depth * 6 * share * (1 - share) / 0.02 : 0.0);
  r.angular_velocity = Vec3(0.0, speed, 0.0);
  r.orientation = Quat(Eigen::AngleAxisd(speed * time, Vec3::UnitY()));
  return r;
}

using LedTire = Led<tire::AncfTire>;

/// A tire that rolls into a ground.
struct Rolling : LedTire {
  double step = 1e-4, speed = 8.0, depth = 0.008;  // s, rad/s, m

  explicit Rolling(const tire::TireFile& file, const tire::ShellIntegratorParams& params = {}, double spin = 8.0,
                   double sinks = 0.008)
      : Led({}, file, params), speed(spin), depth(sinks) {
    path = tire::RimTrajectory(at(0));
    tire.place(path.start());
  }
  RimState at(int n) const { return rolling_rim(n * step, tire.radius(), speed, depth); }
  void interval(int n, int substeps = 1) { go(at(n), step, ground_forces(tire), substeps); }
  void intervals(int count) {
    for (int n = 0; n < count; ++n) interval(n);
  }
};

/// Momentum and angular momentum about the origin, with the consistent mass.
inline std::pair<Vec3, Vec3> momenta(const tire::AncfTire& tire) {
  const tire::ShellLayout& layout = tire.integrator().layout();
  const tire::Field &q = tire.integrator().q(), &v = tire.integrator().v();
  tire::Field p(layout.size(), 0.0);
  tire.integrator().mass().apply(v, 1.0, p);
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  for (int j = 0; j < layout.rows; ++j)
    for (int i = 0; i < layout.columns; ++i) {
      linear += layout.get(p, i, j, 0);
      for (const int s : {0, 3}) angular += layout.get(q, i, j, s).cross(layout.get(p, i, j, s));
    }
  return {linear, angular};
}

/// Rolls 120 intervals, saves, and continues for 80 with the tire and with a restored one. Checks that both have the
/// same bits.
/// @param prepare called with a tire and the interval's number before each interval
template <class Prepare>
void expect_restart_bit_for_bit(const tire::TireFile& file, Prepare prepare) {
  Rolling one(file), other(file);
  const auto advance = [&](Rolling& which, int n) {
    prepare(which.tire, n);
    which.interval(n, 2);
  };
  for (int n = 0; n < 120; ++n) advance(one, n);
  other.tire.restore(testing::saved(one.tire));
  other.path = one.path;
  for (int n = 120; n < 200; ++n) advance(one, n), advance(other, n);
  EXPECT_EQ(one.tire.integrator().q(), other.tire.integrator().q());
  EXPECT_EQ(one.tire.integrator().v(), other.tire.integrator().v());
  EXPECT_EQ(one.tire.spindle_wrench().moment, other.tire.spindle_wrench().moment);
  const tire::TireDiagnostics a = one.tire.diagnostics(), b = other.tire.diagnostics();
  for (const tire::NamedValue& figure : one.tire.figures())
    EXPECT_EQ(figure.value, other.tire.figures().of(figure.name)) << figure.name;
  EXPECT_EQ(a.losses(), b.losses());
  EXPECT_EQ(a.momentum, b.momentum);
  EXPECT_EQ(a.strain_energy(), b.strain_energy());
  EXPECT_GT(one.tire.figures().of("factorizations"), 0);
}

}  // namespace furrow::test
