// Builds the bodies and joints of an axle into a system: from a spec to indices.
//
//   double_wishbone  upright, spindle and two arms per side; a tie rod as a distance
//   trailing_arm     arm and spindle per side
//   rigid_axle       one housing, two spindles; four rods as distances
//   fixed            a spindle per side in the chassis or in the trailing arm of another axle
#pragma once

#include <array>
#include <optional>
#include <string>

#include "vehicle/multibody/system.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// Two points of the steering axis, in the axes of the wheel's carrier, from its centre of mass, m.
struct Kingpin {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// A wheel's place in the system.
struct Wheel {
  std::string name;  // "front left"
  int axle = 0, side = kLeft;
  int spindle =
      0;  // body that turns, with rim and, once added, tire; its centre of mass is the rim's centre, y the axle
  int carrier = 0;                   // body that the bearing sits in: upright, arm, housing or chassis
  int bearing = 0;                   // joint
  bool travels = true;               // has a spring's freedom of its own
  std::optional<int> spring, shock;  // force elements
  std::optional<Kingpin> kingpin;
  const CornerSpec* corner = nullptr;
};

/// @param chassis body @param rods body that the tie rods' inner ends are on: the chassis, a link or a rack
std::array<Wheel, 2> add_axle(System& system, const AxleSpec& axle, int index, int chassis, int rods,
                              const std::array<Wheel, 2>* host);

int add_body(System& system, const std::string& name, const BodySpec& spec);

}  // namespace furrow::vehicle
