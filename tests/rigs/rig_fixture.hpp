// A drawbar rig with a tire's mass, placed at a height of half a metre.
#pragma once

#include <array>
#include <memory>

#include "rigs/drawbar_rig.hpp"
#include "tests/rigs/reference_options.hpp"
#include "tests/rigs/rig_probe.hpp"

namespace furrow::testing {
inline constexpr double kRadius = 0.4673;  // m
inline constexpr double kTireMass = 4.8;   // kg
inline constexpr double kTireSpin = 0.78;  // kg m²
inline constexpr double kStep = 4e-5;      // s

inline MassProperties tire_mass(double scale = 1.0) {
  MassProperties tire;
  tire.mass = scale * kTireMass;
  tire.inertia = scale * Vec3(0.5, kTireSpin, 0.5).asDiagonal().toDenseMatrix();
  return tire;
}

inline std::unique_ptr<rigs::Rig> placed_rig(const rigs::DrawbarRigOptions& options,
                                             const MassProperties& tire = tire_mass()) {
  auto rig = rigs::make_drawbar_rig(options);
  rig->add_tire_mass(0, tire, kRadius);
  const std::array<double, 1> height = {0.5};
  rig->place(height);
  return rig;
}

inline double carried_mass(const rigs::DrawbarRigOptions& options) {
  return options.carrier_mass + options.rim_mass + kTireMass;
}

inline void advance(rigs::Rig& rig, const Wrench& wrench, int count, double step = kStep, int substeps = 1) {
  for (int i = 0; i < count; ++i) {
    const Outcome outcome = rig.advance({&wrench, 1}, step, substeps);
    if (!outcome.ok) throw physics_error(outcome, "rig");
  }
}

inline Wrench wrench(const Vec3& force, const Vec3& moment = Vec3::Zero()) { return {force, moment}; }

/// Options with full speed from the start and no touch-down damper.
inline rigs::DrawbarRigOptions steady_options() {
  rigs::DrawbarRigOptions options = reference_options();
  options.ramp = 0.0;
  options.touchdown_damping = 0.0;
  return options;
}

}  // namespace furrow::testing
