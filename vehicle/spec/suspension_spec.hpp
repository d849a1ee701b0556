// What a vehicle file says of bodies, suspensions, wheels and brakes. Points are in m, in the vehicle's frame: x
// forward, y left, z up. A file gives them from the origin of their axle; the reader adds it.
// Every Vec3 in here is a point.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/core/vec.hpp"
#include "vehicle/spec/part_keys.hpp"

namespace furrow::vehicle {

/// Points of a function; x rises.
using Points = std::vector<std::pair<double, double>>;

struct BodySpec {
  static constexpr SchemaName kSchema{"body", "A rigid body."};
  double mass = 0.0;                   // kg
  Vec3 center_of_mass = Vec3::Zero();  // m
  Mat3 inertia = Mat3::Zero();         // about it, kg m²; in a file [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<BodySpec> auto& s) {
  visit(keys::kMass, s.mass);
  visit(keys::kCenterOfMass, s.center_of_mass);
  visit(keys::kInertia, s.inertia);
}

/// What turns with the wheel, without the wheel; its centre of mass is the wheel's centre.
struct SpindleSpec {
  static constexpr SchemaName kSchema{"spindle", "The hub and what turns with it, without rim and tire."};
  Vec3 center = Vec3::Zero();   // m
  double mass = 0.0;            // kg
  Mat3 inertia = Mat3::Zero();  // kg m², y along the spin axis
  double camber_deg = 0.0;      // as drawn; positive: the wheel's top leans outward
  double toe_deg = 0.0;         // as drawn; positive: toe-in
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<SpindleSpec> auto& s) {
  using namespace allowed;
  visit(needed("center", "m", keys::kPoint, "Centre of the wheel, from the axle's origin."), s.center);
  visit(keys::kMass, s.mass);
  visit(keys::kInertia, s.inertia);
  visit(key("camber_deg", "deg", above(-45).below(45), "Camber of the drawn wheel; positive: the top leans outward."),
        s.camber_deg);
  visit(key("toe_deg", "deg", above(-45).below(45), "Toe of the drawn wheel; positive: toe-in."), s.toe_deg);
}

/// Hinged to the chassis, with a ball at the upright. Its inertia is in axes of its own: x along the hinge from back to
/// front, z normal to the plane of its three points, upward.
struct ArmSpec {
  static constexpr SchemaName kSchema{"arm",
                                      "An arm that is hinged to the chassis, with a ball at the upright. Its inertia "
                                      "is in axes with x along the hinge and z normal to its plane."};
  double mass = 0.0;                                               // kg
  Vec3 center_of_mass = Vec3::Zero();                              // m
  Mat3 inertia = Mat3::Zero();                                     // kg m²
  Vec3 chassis_front = Vec3::Zero(), chassis_back = Vec3::Zero();  // of the hinge, m
  Vec3 upright = Vec3::Zero();                                     // ball, m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ArmSpec> auto& s) {
  visit(keys::kMass, s.mass);
  visit(keys::kCenterOfMass, s.center_of_mass);
  visit(keys::kInertia, s.inertia);
  visit(needed("chassis_front", "m", keys::kPoint, "Front point of the hinge on the chassis, from the axle's origin."),
        s.chassis_front);
  visit(needed("chassis_back", "m", keys::kPoint, "Rear point of the hinge on the chassis, from the axle's origin."),
        s.chassis_back);
  visit(needed("upright", "m", keys::kPoint, "Ball joint at the upright, from the axle's origin."), s.upright);
}

/// A massless rod; its inner end is on the steering link or the rack, of an axle that is not steered on the chassis.
struct TieRodSpec {
  static constexpr SchemaName kSchema{"tie_rod",
                                      "A massless rod. Its inner end is on the steering link or the rack, or on the "
                                      "chassis if the axle is not steered."};
  Vec3 inner = Vec3::Zero(), outer = Vec3::Zero();  // m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<TieRodSpec> auto& s) {
  visit(needed("inner", "m", keys::kPoint, "Inner end, from the axle's origin."), s.inner);
  visit(needed("outer", "m", keys::kPoint, "Outer end on the upright, from the axle's origin."), s.outer);
}

/// Acts beyond `shortest` and `longest`, added to the spring.
struct StopSpec {
  static constexpr SchemaName kSchema{"stop",
                                      "Stops that act below one length and above another, in addition to the spring."};
  double shortest = 0.0, longest = 0.0;  // m
  Points force;                          // N against m beyond the mark
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<StopSpec> auto& s) {
  using namespace allowed;
  visit(needed("shortest", "m", above(0), "Length below which it acts."), s.shortest);
  visit(needed("longest", "m", above(0), "Length above which it acts."), s.longest);
  visit(needed("force", "N", keys::kTable,
               "Pairs of length beyond the mark, m, and force, N; begins with [0, 0] and rises."),
        s.force);
}

/// A coil spring: either a rate or a table of force against deflection, which is an odd function.
struct SpringSpec {
  static constexpr SchemaName kSchema{
      "spring", "A spring between the chassis and a part of the suspension; one of rate and force."};
  Vec3 chassis = Vec3::Zero(), end = Vec3::Zero();  // m
  std::optional<std::string> on;                    // the part that `end` is on
  double free_length = 0.0;                         // m
  std::optional<double> rate;                       // N/m
  Points force;                                     // N against m
  std::optional<StopSpec> stop;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<SpringSpec> auto& s) {
  using namespace allowed;
  visit(keys::kChassisEnd, s.chassis);
  visit(keys::kEnd, s.end);
  visit(keys::kOn, s.on);
  visit(needed("free_length", "m", above(0), "Length without force."), s.free_length);
  visit(key("rate", "N/m", above(0).to(1e10), "Stiffness."), s.rate);
  visit(key("force", "N", keys::kTable,
            "Pairs of deflection, m, and force, N, straight between them; begins with [0, 0] and rises; odd."),
        s.force);
  visit(key("stop"), s.stop);
}

/// Coefficients of a shock absorber outside two lengths; they change over `blend_length` about each.
struct OuterShockSpec {
  static constexpr SchemaName kSchema{"outer_shock", "Coefficients outside of two lengths."};
  double shortest = 0.0, longest = 0.0;     // m
  double blend_length = 0.0;                // m
  double compression = 0.0, rebound = 0.0;  // N s/m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<OuterShockSpec> auto& s) {
  using namespace allowed;
  visit(needed("shortest", "m", above(0), "Length below which these coefficients hold."), s.shortest);
  visit(needed("longest", "m", above(0), "Length above which these coefficients hold."), s.longest);
  visit(needed("blend_length", "m", above(0), "Length over which the coefficients change at each mark."),
        s.blend_length);
  visit(keys::kCompression, s.compression);
  visit(keys::kRebound, s.rebound);
}

struct ShockSpec {
  static constexpr SchemaName kSchema{"shock", "A shock absorber between the chassis and a part of the suspension."};
  Vec3 chassis = Vec3::Zero(), end = Vec3::Zero();  // m
  std::optional<std::string> on;                    // the part that `end` is on
  double compression = 0.0, rebound = 0.0;          // N s/m
  std::optional<OuterShockSpec> outer;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ShockSpec> auto& s) {
  visit(keys::kChassisEnd, s.chassis);
  visit(keys::kEnd, s.end);
  visit(keys::kOn, s.on);
  visit(keys::kCompression, s.compression);
  visit(keys::kRebound, s.rebound);
  visit(key("outer"), s.outer);
}

struct DoubleWishboneSpec {
  static constexpr SchemaName kSchema{"double_wishbone", "Two arms, an upright and a tie rod on each side."};
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
  visit(needed("spindle"), s.spindle);
  visit(needed("upright"), s.upright);
  visit(needed("upper_arm"), s.upper_arm);
  visit(needed("lower_arm"), s.lower_arm);
  visit(needed("tie_rod"), s.tie_rod);
  visit(key("spring"), s.spring);
  visit(key("shock"), s.shock);
}

/// An arm that is hinged to the chassis about the line through its two pivots and carries the wheel's bearing:
/// trailing, semi-trailing, or without a spring one half of a walking beam (see FixedSpec).
struct TrailingArmSpec {
  static constexpr SchemaName kSchema{
      "trailing_arm",
      "An arm on each side that carries the wheel's bearing and turns about the line through its pivots."};
  static constexpr const char* kType = "trailing_arm";
  SpindleSpec spindle;
  BodySpec arm;
  Vec3 pivot_inner = Vec3::Zero(), pivot_outer = Vec3::Zero();  // m
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<TrailingArmSpec> auto& s) {
  visit(needed("spindle"), s.spindle);
  visit(needed("arm"), s.arm);
  visit(needed("pivot_inner", "m", keys::kPoint, "Inner pivot on the chassis, from the axle's origin."), s.pivot_inner);
  visit(needed("pivot_outer", "m", keys::kPoint, "Outer pivot on the chassis, from the axle's origin."), s.pivot_outer);
  visit(key("spring"), s.spring);
  visit(key("shock"), s.shock);
}

/// A massless rod with balls at both ends.
struct LinkSpec {
  static constexpr SchemaName kSchema{"link", "A massless rod between the chassis and the axle."};
  std::string name;
  Vec3 chassis = Vec3::Zero(), axle = Vec3::Zero();  // m
  bool mirrored = true;                              // there is one on the right, too
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<LinkSpec> auto& s) {
  using namespace allowed;
  visit(needed("name", "", not_empty(), "Name of the rod in messages."), s.name);
  visit(keys::kChassisEnd, s.chassis);
  visit(needed("axle", "m", keys::kPoint, "End on the axle, from the axle's origin."), s.axle);
  visit(key("mirrored", "", "Whether the right side has the mirror image of the rod."), s.mirrored);
}

/// One housing for both wheels, guided by links.
struct RigidAxleSpec {
  static constexpr SchemaName kSchema{"rigid_axle", "One housing for both wheels, on four rods."};
  static constexpr const char* kType = "rigid_axle";
  SpindleSpec spindle;
  BodySpec housing;
  std::vector<LinkSpec> links;
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<RigidAxleSpec> auto& s) {
  visit(needed("spindle"), s.spindle);
  visit(needed("housing"), s.housing);
  visit(needed("links", "", "Four rods; a mirrored one counts twice."), s.links);
  visit(key("spring"), s.spring);
  visit(key("shock"), s.shock);
}

/// The wheel's bearing sits in the chassis, or on the trailing arm of another axle: a walking beam carries two wheels.
struct FixedSpec {
  static constexpr SchemaName kSchema{
      "fixed", "The wheel's bearing sits in the chassis, or on the trailing arm of another axle."};
  static constexpr const char* kType = "fixed";
  SpindleSpec spindle;
  std::optional<std::string> on;  // name of the axle
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<FixedSpec> auto& s) {
  using namespace allowed;
  visit(needed("spindle"), s.spindle);
  visit(key("on", "", not_empty(),
            "Name of the axle whose trailing arms carry these wheels. Without this key the chassis carries them."),
        s.on);
}

using SuspensionSpec = std::variant<DoubleWishboneSpec, TrailingArmSpec, RigidAxleSpec, FixedSpec>;

struct WheelSpec {
  static constexpr SchemaName kSchema{"wheel", "A rim and its tire."};
  double mass = 0.0;            // rim without tire, kg
  Mat3 inertia = Mat3::Zero();  // about the wheel's centre, kg m², y along the spin axis
  std::string tire;             // name of a tire file
  bool rigid = false;           // the tire is not to deform
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<WheelSpec> auto& s) {
  using namespace allowed;
  visit(needed("mass", "kg", above(0).to(1e7), "Rim without tire."), s.mass);
  visit(keys::kInertia, s.inertia);
  visit(needed("tire", "", not_empty(), "Name of a tire file."), s.tire);
  visit(key("rigid", "", "The tire does not deform."), s.rigid);
}

/// Dry friction between the spindle and what carries its bearing.
struct BrakeSpec {
  static constexpr SchemaName kSchema{"brake", "Dry friction between the spindle and what carries its bearing."};
  double torque = 0.0;  // with the pedal fully down, N m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<BrakeSpec> auto& s) {
  using namespace allowed;
  visit(needed("torque", "N m", above(0).to(1e8), "Torque of the brake with the pedal fully down."), s.torque);
}

}  // namespace furrow::vehicle
