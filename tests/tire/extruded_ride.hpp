// Common parts of the tests of extruded tires: a ride on a rim that accelerates and shifts sideways.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/refusal.hpp"
#include "tests/saved.hpp"
#include "tests/tire/led_tire.hpp"
#include "tire/outward.hpp"
#include "tire/tires.hpp"

namespace furrow::tire {

inline constexpr double kLow = 0.45;  // below the axle: the forces of a ride act there, m

inline RimState rim_at(double t, double toe = 0.0) {
  RimState rim;
  rim.position = Vec3(3.0 * t + 0.4 * t * t, 0.2 * t, 0.5 - 0.05 * t);
  rim.velocity = Vec3(3.0 + 0.8 * t, 0.2, -0.05);
  const Quat plane(Eigen::AngleAxisd(toe, Vec3::UnitZ()));
  rim.orientation = plane * Quat(Eigen::AngleAxisd(6.0 * t + t * t, Vec3::UnitY()));
  rim.angular_velocity = plane * Vec3(0.0, 6.0 + 2.0 * t, 0.0);
  return rim;
}

/// Forces that vary in time on the lower half of the tread, different on both sides, and on the middle of a side.
inline NodalForces loads(const SurfaceState& surface, const RimState& rim, double t) {
  NodalForces f;
  const int last = static_cast<int>(surface.position.size()) - 2;
  for (int v = 0; v < last; ++v) {
    if (surface.position[v].z() > rim.position.z() - kLow) continue;
    f.vertex.push_back(v);
    f.force.push_back(Vec3(80.0 * std::sin(50.0 * t + v), 30.0, (v % 2 ? 400.0 : 300.0) * (1.0 + std::sin(90.0 * t))));
  }
  f.vertex.push_back(last);
  f.force.push_back(Vec3(5.0, -3.0, 7.0));
  return f;
}

struct Ride {
  double worst_force = 0.0;           // of Δ momentum − impulses over the largest impulse
  double work = 0.0, residual = 0.0;  // J
  TireDiagnostics first, last;

  explicit Ride(const TireOptions& options, double step, double toe = 0.0, double end = 0.1) {
    const auto tire = make_tire(options);
    const RimState start = rim_at(0.0, toe);
    RimTrajectory rim(start);
    tire->place(start);
    first = tire->diagnostics();
    SurfaceState before, after;
    double rim_work = 0.0, terrain_work = 0.0;
    const int steps = static_cast<int>(std::lround(end / step));
    for (int k = 0; k < steps; ++k) {
      rim.extend(rim_at(k * step, toe), step);
      tire->surface(before);
      const NodalForces f = loads(before, rim.start(), k * step);
      const Vec3 momentum = tire->diagnostics().momentum;
      const Outcome outcome = tire->advance(rim, f, 1);
      EXPECT_TRUE(outcome.ok) << outcome.message("tire");
      tire->surface(after);
      const Wrench spindle = tire->spindle_wrench();
      Vec3 impulse = step * (tire->mass_properties().mass * tire->gravity() - spindle.force);
      double size = impulse.norm();
      for (const Vec3& force : f.force) impulse += step * force, size += step * force.norm();
      terrain_work += test::surface_work(f, before, after);
      const double off = (tire->diagnostics().momentum - momentum - impulse).norm() / size;
      worst_force = std::max(worst_force, off);
      rim_work += test::rim_work(*tire, rim);
    }
    last = tire->diagnostics();
    work = std::abs(rim_work) + std::abs(terrain_work);
    residual = rim_work + terrain_work - (last.stored() - first.stored()) - last.losses();
  }
};

inline void expect_exact_continuation(const TireOptions& options, double step) {
  const auto one = make_tire(options), other = make_tire(options);
  RimTrajectory rim(rim_at(0.0, 0.05));
  one->place(rim.end());
  const auto go = [&](Tire& tire, RimTrajectory& motion, int from, int to) {
    SurfaceState surface;
    for (int k = from; k < to; ++k) {
      motion.extend(rim_at(k * step, 0.05), step);
      tire.surface(surface);
      ASSERT_TRUE(tire.advance(motion, loads(surface, motion.start(), k * step), 2).ok);
    }
  };
  go(*one, rim, 0, 333);
  other->restore(testing::saved(*one));
  RimTrajectory copy = rim;
  go(*one, rim, 333, 700);
  go(*other, copy, 333, 700);
  SurfaceState a, b;
  one->surface(a), other->surface(b);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(one->spindle_wrench().force, other->spindle_wrench().force);
  EXPECT_EQ(one->spindle_wrench().moment, other->spindle_wrench().moment);
  EXPECT_EQ(one->diagnostics().losses(), other->diagnostics().losses());
  for (const NamedValue& figure : one->figures())
    EXPECT_EQ(figure.value, other->figures().of(figure.name)) << figure.name;
}

/// Checks that a tire agrees with its description, made before it.
inline void expect_described_shape(TireOptions options, bool rigid = false) {
  options.rigid = rigid;
  const auto spec = read_tire(options);
  EXPECT_EQ(spec->static_test() == nullptr, rigid);
  const auto tire = spec->make();
  const TireDescription d = spec->describe();
  EXPECT_EQ(d.vertices, tire->mesh().vertex_count);
  EXPECT_EQ(d.coordinates, tire->coordinates());
  EXPECT_EQ(d.mass.mass, tire->mass_properties().mass);
  EXPECT_EQ(d.static_only, "");
  EXPECT_EQ(d.facets, options.elements_circumference);
  tire->place(RimState());
  SurfaceState s;
  tire->surface(s);
  const TireShape shape = spec->shape();
  for (std::size_t v = 0; v < shape.vertex.size(); ++v) EXPECT_LT((s.position[v] - shape.vertex[v]).norm(), 1e-12);
  EXPECT_NO_THROW(require_outward(tire->mesh(), s.position, Vec3::Zero(), "tire.json"));
  EXPECT_TRUE(rigid || tire->material().area_density > 0.1);
}

/// Checks that a force that is not finite is refused, and that a force that presses the tire to its rim fails with
/// these words.
inline void expect_limits_are_told(const TireOptions& options, double step, const NodalForces& too_much,
                                   const std::string& words) {
  const auto tire = make_tire(options);
  RimState rim;
  RimTrajectory motion(rim);
  tire->place(rim);
  motion.extend(rim, step);
  const NodalForces nothing{{3}, {Vec3(0.0, 0.0, std::numeric_limits<double>::quiet_NaN())}};
  EXPECT_TRUE(holds(tire->advance(motion, nothing, 1).message("tire 0"), "force that is not finite"));
  Outcome outcome;
  for (int k = 0; k < 2000 && outcome.ok; ++k) {
    outcome = tire->advance(motion, too_much, 1);
    motion.extend(rim, step);
  }
  EXPECT_FALSE(outcome.ok);
  EXPECT_TRUE(holds(outcome.message("tire 0"), words));
}

}  // namespace furrow::tire
