// Parts of the suspensions in a vehicle file. Points are in m, in the vehicle's frame: x forward, y left, z up. A file
// gives them relative to the origin of their axle; the reader adds this origin. Every Vec3 in this header is a point.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
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
void visit_fields(FieldsOf<BodySpec> auto& s, auto&& visit) {
  visit(s.mass, keys::kMass);
  visit(s.center_of_mass, keys::kCenterOfMass);
  visit(s.inertia, keys::kInertia);
}

/// The parts that turn with the wheel, without the wheel. Their centre of mass is the wheel's centre.
struct SpindleSpec {
  static constexpr SchemaName kSchema{"spindle", "The hub and what turns with it, without rim and tire."};
  Vec3 center = Vec3::Zero();   // m
  double mass = 0.0;            // kg
  Mat3 inertia = Mat3::Zero();  // kg m², y along the spin axis
  double camber_deg = 0.0;      // as drawn; positive: the wheel's top leans outward
  double toe_deg = 0.0;         // as drawn; positive: toe-in
};
void visit_fields(FieldsOf<SpindleSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.center, needed("center", "m", keys::kPoint, "Centre of the wheel, from the axle's origin."));
  visit(s.mass, keys::kMass);
  visit(s.inertia, keys::kInertia);
  visit(s.camber_deg,
        key("camber_deg", "deg", above(-45).below(45), "Camber of the drawn wheel; positive: the top leans outward."));
  visit(s.toe_deg, key("toe_deg", "deg", above(-45).below(45), "Toe of the drawn wheel; positive: toe-in."));
}

/// An arm with a hinge on the chassis and a ball at the upright. Its inertia is in its own axes: x along the hinge from
/// back to front, z normal to the plane of its three points, upward.
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
void visit_fields(FieldsOf<ArmSpec> auto& s, auto&& visit) {
  visit(s.mass, keys::kMass);
  visit(s.center_of_mass, keys::kCenterOfMass);
  visit(s.inertia, keys::kInertia);
  visit(s.chassis_front,
        needed("chassis_front", "m", keys::kPoint, "Front point of the hinge on the chassis, from the axle's origin."));
  visit(s.chassis_back,
        needed("chassis_back", "m", keys::kPoint, "Rear point of the hinge on the chassis, from the axle's origin."));
  visit(s.upright, needed("upright", "m", keys::kPoint, "Ball joint at the upright, from the axle's origin."));
}

/// A massless rod. Its inner end is on the steering link or the rack, or on the chassis if the axle is not steered.
struct TieRodSpec {
  static constexpr SchemaName kSchema{"tie_rod",
                                      "A massless rod. Its inner end is on the steering link or the rack, or on the "
                                      "chassis if the axle is not steered."};
  Vec3 inner = Vec3::Zero(), outer = Vec3::Zero();  // m
};
void visit_fields(FieldsOf<TieRodSpec> auto& s, auto&& visit) {
  visit(s.inner, needed("inner", "m", keys::kPoint, "Inner end, from the axle's origin."));
  visit(s.outer, needed("outer", "m", keys::kPoint, "Outer end on the upright, from the axle's origin."));
}

/// A stop that acts beyond `shortest` and `longest`, in addition to the spring.
struct StopSpec {
  static constexpr SchemaName kSchema{"stop",
                                      "Stops that act below one length and above another, in addition to the spring."};
  double shortest = 0.0, longest = 0.0;  // m
  Points force;                          // N against m beyond these lengths
};
void visit_fields(FieldsOf<StopSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.shortest, needed("shortest", "m", above(0), "Length below which it acts."));
  visit(s.longest, needed("longest", "m", above(0), "Length above which it acts."));
  visit(s.force, needed("force", "N", keys::kTable,
                        "Pairs of length beyond the mark, m, and force, N; begins with [0, 0] and rises."));
}

/// A coil spring, with a rate or a table of force against deflection; the table is continued as an odd function.
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
void visit_fields(FieldsOf<SpringSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.chassis, keys::kChassisEnd);
  visit(s.end, keys::kEnd);
  visit(s.on, keys::kOn);
  visit(s.free_length, needed("free_length", "m", above(0), "Length without force."));
  visit(s.rate, key("rate", "N/m", above(0).to(1e10), "Stiffness."));
  visit(s.force,
        key("force", "N", keys::kTable,
            "Pairs of deflection, m, and force, N, straight between them; begins with [0, 0] and rises; odd."));
  visit(s.stop, key("stop"));
}

/// Coefficients of a shock absorber outside two lengths; they change over `blend_length` about each.
struct OuterShockSpec {
  static constexpr SchemaName kSchema{"outer_shock", "Coefficients outside of two lengths."};
  double shortest = 0.0, longest = 0.0;     // m
  double blend_length = 0.0;                // m
  double compression = 0.0, rebound = 0.0;  // N s/m
};
void visit_fields(FieldsOf<OuterShockSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.shortest, needed("shortest", "m", above(0), "Length below which these coefficients hold."));
  visit(s.longest, needed("longest", "m", above(0), "Length above which these coefficients hold."));
  visit(s.blend_length,
        needed("blend_length", "m", above(0), "Length over which the coefficients change at each mark."));
  visit(s.compression, keys::kCompression);
  visit(s.rebound, keys::kRebound);
}

struct ShockSpec {
  static constexpr SchemaName kSchema{"shock", "A shock absorber between the chassis and a part of the suspension."};
  Vec3 chassis = Vec3::Zero(), end = Vec3::Zero();  // m
  std::optional<std::string> on;                    // the part that `end` is on
  double compression = 0.0, rebound = 0.0;          // N s/m
  std::optional<OuterShockSpec> outer;
};
void visit_fields(FieldsOf<ShockSpec> auto& s, auto&& visit) {
  visit(s.chassis, keys::kChassisEnd);
  visit(s.end, keys::kEnd);
  visit(s.on, keys::kOn);
  visit(s.compression, keys::kCompression);
  visit(s.rebound, keys::kRebound);
  visit(s.outer, key("outer"));
}

/// An axle under construction: vehicle/parts/suspension_kinds.hpp.
struct AxleBuild;

/// The suspension of the left side and that of the right one.
template <class Spec>
using Sides = std::array<const Spec*, 2>;

}  // namespace furrow::vehicle
