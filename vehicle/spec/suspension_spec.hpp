// Suspensions, wheels and brakes of a vehicle file, in the frame of part_spec.hpp. A new kind of suspension has its own
// header, and its name in SuspensionSpec.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/core/vec.hpp"
#include "vehicle/spec/part_keys.hpp"
#include "vehicle/spec/part_spec.hpp"

namespace furrow::vehicle {

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
void visit_fields(FieldsOf<DoubleWishboneSpec> auto& s, auto&& visit) {
  visit(s.spindle, needed("spindle"));
  visit(s.upright, needed("upright"));
  visit(s.upper_arm, needed("upper_arm"));
  visit(s.lower_arm, needed("lower_arm"));
  visit(s.tie_rod, needed("tie_rod"));
  visit(s.spring, key("spring"));
  visit(s.shock, key("shock"));
}
void add_suspension(AxleBuild& build, const Sides<DoubleWishboneSpec>& sides);

/// An arm that is hinged to the chassis about the line through its two pivots and carries the wheel's bearing:
/// trailing, semi-trailing, or, without a spring, half of a walking beam (see FixedSpec).
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
void visit_fields(FieldsOf<TrailingArmSpec> auto& s, auto&& visit) {
  visit(s.spindle, needed("spindle"));
  visit(s.arm, needed("arm"));
  visit(s.pivot_inner, needed("pivot_inner", "m", keys::kPoint, "Inner pivot on the chassis, from the axle's origin."));
  visit(s.pivot_outer, needed("pivot_outer", "m", keys::kPoint, "Outer pivot on the chassis, from the axle's origin."));
  visit(s.spring, key("spring"));
  visit(s.shock, key("shock"));
}
void add_suspension(AxleBuild& build, const Sides<TrailingArmSpec>& sides);

/// A massless rod with balls at both ends.
struct LinkSpec {
  static constexpr SchemaName kSchema{"link", "A massless rod between the chassis and the axle."};
  std::string name;
  Vec3 chassis = Vec3::Zero(), axle = Vec3::Zero();  // m
  bool mirrored = true;                              // whether the right side has one, too
};
void visit_fields(FieldsOf<LinkSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.name, needed("name", "", not_empty(), "Name of the rod in messages."));
  visit(s.chassis, keys::kChassisEnd);
  visit(s.axle, needed("axle", "m", keys::kPoint, "End on the axle, from the axle's origin."));
  visit(s.mirrored, key("mirrored", "", "Whether the right side has the mirror image of the rod."));
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
void visit_fields(FieldsOf<RigidAxleSpec> auto& s, auto&& visit) {
  visit(s.spindle, needed("spindle"));
  visit(s.housing, needed("housing"));
  visit(s.links, needed("links", "", "Four rods; a mirrored one counts twice."));
  visit(s.spring, key("spring"));
  visit(s.shock, key("shock"));
}
void add_suspension(AxleBuild& build, const Sides<RigidAxleSpec>& sides);

/// The wheel's bearing sits in the chassis, or on the trailing arm of another axle: a walking beam carries two wheels.
struct FixedSpec {
  static constexpr SchemaName kSchema{
      "fixed", "The wheel's bearing sits in the chassis, or on the trailing arm of another axle."};
  static constexpr const char* kType = "fixed";
  SpindleSpec spindle;
  std::optional<std::string> on;  // name of the axle
};
void visit_fields(FieldsOf<FixedSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.spindle, needed("spindle"));
  visit(s.on,
        key("on", "", not_empty(),
            "Name of the axle whose trailing arms carry these wheels. Without this key the chassis carries them."));
}
void add_suspension(AxleBuild& build, const Sides<FixedSpec>& sides);

using SuspensionSpec = std::variant<DoubleWishboneSpec, TrailingArmSpec, RigidAxleSpec, FixedSpec>;

struct WheelSpec {
  static constexpr SchemaName kSchema{"wheel", "A rim and its tire."};
  double mass = 0.0;            // rim without tire, kg
  Mat3 inertia = Mat3::Zero();  // about the wheel's centre, kg m², y along the spin axis
  std::string tire;             // name of a tire file
  bool rigid = false;           // whether the tire is kept rigid
};
void visit_fields(FieldsOf<WheelSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.mass, needed("mass", "kg", above(0).to(1e7), "Rim without tire."));
  visit(s.inertia, keys::kInertia);
  visit(s.tire, needed("tire", "", not_empty(), "Name of a tire file."));
  visit(s.rigid, key("rigid", "", "The tire does not deform."));
}

/// Dry friction between the spindle and the body that holds its bearing.
struct BrakeSpec {
  static constexpr SchemaName kSchema{"brake", "Dry friction between the spindle and what carries its bearing."};
  double torque = 0.0;  // with the pedal fully down, N m
};
void visit_fields(FieldsOf<BrakeSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.torque, needed("torque", "N m", above(0).to(1e8), "Torque of the brake with the pedal fully down."));
}

}  // namespace furrow::vehicle
