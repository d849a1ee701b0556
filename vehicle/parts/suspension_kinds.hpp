// Parts of the kinds of suspensions. Each kind has its own add_suspension() (vehicle/spec/suspension_spec.hpp):
//
//   double_wishbone  upright, spindle and two arms per side; a tie rod as a distance
//   trailing_arm     arm and spindle per side
//   rigid_axle       one housing, two spindles; four rods as distances
//   fixed            a spindle per side in the chassis or in the trailing arm of another axle
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>

#include "vehicle/multibody/system.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// Two points of the steering axis, in the axes of the wheel's carrier, from its centre of mass, m.
struct Kingpin {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// Indices of a wheel's parts in the system.
struct Wheel {
  std::string name;  // "front left"
  int axle = 0, side = kLeft;
  int spindle =
      0;  // body that turns, with rim and, once added, tire; its centre of mass is the rim's centre, y the axle
  int carrier = 0;                   // body that the bearing sits in: upright, arm, housing or chassis
  int bearing = 0;                   // joint
  bool travels = true;               // has its own freedom on a spring
  std::optional<int> spring, shock;  // force elements
  std::optional<Kingpin> kingpin;
  const CornerSpec* corner = nullptr;
};

/// An axle under construction. Each add_suspension() sets the wheels' carriers, spindles, bearings and struts.
struct AxleBuild {
  System& system;
  const AxleSpec& axle;
  int chassis = 0, rods = 0;                   // bodies: the chassis, and the holder of the tie rods' inner ends
  const std::array<Wheel, 2>* host = nullptr;  // wheels of the axle that carries these wheels' bearings
  std::array<Wheel, 2> wheels;                 // left, right
};

int add_body(System& system, const std::string& name, const BodySpec& spec);
int add_joint(System& system, JointKind kind, const std::string& name, int a, int b, const Vec3& point,
              const Vec3& axis = Vec3::UnitZ());
void add_rod(System& system, const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b);

/// Adds the body that turns in the wheel's carrier, including the rim.
void add_spindle(System& system, Wheel& wheel, const SpindleSpec& spindle);

/// A part of one side, with its name in files.
struct Part {
  const char* name;
  int body;
};
/// Adds spring and shock absorber between the chassis and one of the parts, by default the first.
void add_struts(AxleBuild& build, Wheel& wheel, const std::optional<SpringSpec>& spring,
                const std::optional<ShockSpec>& shock, std::initializer_list<Part> parts);

}  // namespace furrow::vehicle
