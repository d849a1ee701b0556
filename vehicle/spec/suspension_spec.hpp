// What a vehicle file says of suspensions, wheels and brakes, in the frame of part_spec.hpp. A new kind of suspension
// has a header of its own, and its name in SuspensionSpec.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"
#include "vehicle/spec/part_spec.hpp"
#include "vehicle/spec/spec_roles.hpp"

namespace furrow::vehicle {

struct DoubleWishboneSpec {
  static constexpr const char* kType = "double_wishbone";
  SpindleSpec spindle;
  BodySpec upright;
  ArmSpec upper_arm, lower_arm;
  TieRodSpec tie_rod;
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DoubleWishboneSpec> auto& s) {
  visit(Field{"spindle", "", role::key}, s.spindle);
  visit(Field{"upright", "", role::key}, s.upright);
  visit(Field{"upper_arm", "", role::key}, s.upper_arm);
  visit(Field{"lower_arm", "", role::key}, s.lower_arm);
  visit(Field{"tie_rod", "", role::key}, s.tie_rod);
  visit(Field{"spring", "", role::key}, s.spring);
  visit(Field{"shock", "", role::key}, s.shock);
}
void add_suspension(AxleBuild& build, const Sides<DoubleWishboneSpec>& sides);

/// An arm that is hinged to the chassis about the line through its two pivots and carries the wheel's bearing:
/// trailing, semi-trailing, or without a spring one half of a walking beam (see FixedSpec).
struct TrailingArmSpec {
  static constexpr const char* kType = "trailing_arm";
  SpindleSpec spindle;
  BodySpec arm;
  Vec3 pivot_inner = Vec3::Zero(), pivot_outer = Vec3::Zero();  // m
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<TrailingArmSpec> auto& s) {
  visit(Field{"spindle", "", role::key}, s.spindle);
  visit(Field{"arm", "", role::key}, s.arm);
  visit(Field{"pivot_inner", "m", role::key}, s.pivot_inner);
  visit(Field{"pivot_outer", "m", role::key}, s.pivot_outer);
  visit(Field{"spring", "", role::key}, s.spring);
  visit(Field{"shock", "", role::key}, s.shock);
}
void add_suspension(AxleBuild& build, const Sides<TrailingArmSpec>& sides);

/// A massless rod with balls at both ends.
struct LinkSpec {
  std::string name;
  Vec3 chassis = Vec3::Zero(), axle = Vec3::Zero();  // m
  bool mirrored = true;                              // there is one on the right, too
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<LinkSpec> auto& s) {
  visit(Field{"name", "", role::key}, s.name);
  visit(Field{"chassis", "m", role::key}, s.chassis);
  visit(Field{"axle", "m", role::key}, s.axle);
  visit(Field{"mirrored", "", role::key | kMayMiss}, s.mirrored);
}

/// One housing for both wheels, guided by links.
struct RigidAxleSpec {
  static constexpr const char* kType = "rigid_axle";
  SpindleSpec spindle;
  BodySpec housing;
  std::vector<LinkSpec> links;
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<RigidAxleSpec> auto& s) {
  visit(Field{"spindle", "", role::key}, s.spindle);
  visit(Field{"housing", "", role::key}, s.housing);
  visit(Field{"links", "", role::key}, s.links);
  visit(Field{"spring", "", role::key}, s.spring);
  visit(Field{"shock", "", role::key}, s.shock);
}
void add_suspension(AxleBuild& build, const Sides<RigidAxleSpec>& sides);

/// The wheel's bearing sits in the chassis, or on the trailing arm of another axle: a walking beam carries two wheels.
struct FixedSpec {
  static constexpr const char* kType = "fixed";
  SpindleSpec spindle;
  std::optional<std::string> on;  // name of the axle
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<FixedSpec> auto& s) {
  visit(Field{"spindle", "", role::key}, s.spindle);
  visit(Field{"on", "", role::key}, s.on);
}
void add_suspension(AxleBuild& build, const Sides<FixedSpec>& sides);

using SuspensionSpec = std::variant<DoubleWishboneSpec, TrailingArmSpec, RigidAxleSpec, FixedSpec>;

struct WheelSpec {
  double mass = 0.0;            // rim without tire, kg
  Mat3 inertia = Mat3::Zero();  // about the wheel's centre, kg m², y along the spin axis
  std::string tire;             // name of a tire file
  bool rigid = false;           // the tire is not to deform
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<WheelSpec> auto& s) {
  visit(Field{"mass", "kg", role::key}, s.mass);
  visit(Field{"inertia", "kg m²", role::key}, s.inertia);
  visit(Field{"tire", "", role::key}, s.tire);
  visit(Field{"rigid", "", role::key | kMayMiss}, s.rigid);
}

/// Dry friction between the spindle and what carries its bearing.
struct BrakeSpec {
  double torque = 0.0;  // with the pedal fully down, N m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<BrakeSpec> auto& s) {
  visit(Field{"torque", "N m", role::key}, s.torque);
}

}  // namespace furrow::vehicle
