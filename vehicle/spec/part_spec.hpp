// Parts of which a vehicle file makes suspensions. Points are in m, in the vehicle's frame: x forward, y left, z up. A
// file gives them from the origin of their axle; the reader adds it. Every Vec3 in here is a point.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"
#include "vehicle/spec/spec_roles.hpp"

namespace furrow::vehicle {

/// Points of a function; x rises.
using Points = std::vector<std::pair<double, double>>;

struct BodySpec {
  double mass = 0.0;                   // kg
  Vec3 center_of_mass = Vec3::Zero();  // m
  Mat3 inertia = Mat3::Zero();         // about it, kg m²; in a file [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<BodySpec> auto& s) {
  visit(Field{"mass", "kg", role::key}, s.mass);
  visit(Field{"center_of_mass", "m", role::key}, s.center_of_mass);
  visit(Field{"inertia", "kg m²", role::key}, s.inertia);
}

/// What turns with the wheel, without the wheel; its centre of mass is the wheel's centre.
struct SpindleSpec {
  Vec3 center = Vec3::Zero();   // m
  double mass = 0.0;            // kg
  Mat3 inertia = Mat3::Zero();  // kg m², y along the spin axis
  double camber_deg = 0.0;      // as drawn; positive: the wheel's top leans outward
  double toe_deg = 0.0;         // as drawn; positive: toe-in
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<SpindleSpec> auto& s) {
  visit(Field{"center", "m", role::key}, s.center);
  visit(Field{"mass", "kg", role::key}, s.mass);
  visit(Field{"inertia", "kg m²", role::key}, s.inertia);
  visit(Field{"camber_deg", "deg", role::key | kMayMiss}, s.camber_deg);
  visit(Field{"toe_deg", "deg", role::key | kMayMiss}, s.toe_deg);
}

/// Hinged to the chassis, with a ball at the upright. Its inertia is in axes of its own: x along the hinge from back to
/// front, z normal to the plane of its three points, upward.
struct ArmSpec {
  double mass = 0.0;                                               // kg
  Vec3 center_of_mass = Vec3::Zero();                              // m
  Mat3 inertia = Mat3::Zero();                                     // kg m²
  Vec3 chassis_front = Vec3::Zero(), chassis_back = Vec3::Zero();  // of the hinge, m
  Vec3 upright = Vec3::Zero();                                     // ball, m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ArmSpec> auto& s) {
  visit(Field{"mass", "kg", role::key}, s.mass);
  visit(Field{"center_of_mass", "m", role::key}, s.center_of_mass);
  visit(Field{"inertia", "kg m²", role::key}, s.inertia);
  visit(Field{"chassis_front", "m", role::key}, s.chassis_front);
  visit(Field{"chassis_back", "m", role::key}, s.chassis_back);
  visit(Field{"upright", "m", role::key}, s.upright);
}

/// A massless rod; its inner end is on the steering link or the rack, of an axle that is not steered on the chassis.
struct TieRodSpec {
  Vec3 inner = Vec3::Zero(), outer = Vec3::Zero();  // m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<TieRodSpec> auto& s) {
  visit(Field{"inner", "m", role::key}, s.inner);
  visit(Field{"outer", "m", role::key}, s.outer);
}

/// Acts beyond `shortest` and `longest`, added to the spring.
struct StopSpec {
  double shortest = 0.0, longest = 0.0;  // m
  Points force;                          // N against m beyond the mark
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<StopSpec> auto& s) {
  visit(Field{"shortest", "m", role::key}, s.shortest);
  visit(Field{"longest", "m", role::key}, s.longest);
  visit(Field{"force", "N", role::key}, s.force);
}

/// A coil spring: either a rate or a table of force against deflection, which is an odd function.
struct SpringSpec {
  Vec3 chassis = Vec3::Zero(), end = Vec3::Zero();  // m
  std::optional<std::string> on;                    // the part that `end` is on
  double free_length = 0.0;                         // m
  std::optional<double> rate;                       // N/m
  Points force;                                     // N against m
  std::optional<StopSpec> stop;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<SpringSpec> auto& s) {
  visit(Field{"chassis", "m", role::key}, s.chassis);
  visit(Field{"end", "m", role::key}, s.end);
  visit(Field{"on", "", role::key}, s.on);
  visit(Field{"free_length", "m", role::key}, s.free_length);
  visit(Field{"rate", "N/m", role::key}, s.rate);
  visit(Field{"force", "N", role::key | kMayMiss}, s.force);
  visit(Field{"stop", "", role::key}, s.stop);
}

/// Coefficients of a shock absorber outside two lengths; they change over `blend_length` about each.
struct OuterShockSpec {
  double shortest = 0.0, longest = 0.0;     // m
  double blend_length = 0.0;                // m
  double compression = 0.0, rebound = 0.0;  // N s/m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<OuterShockSpec> auto& s) {
  visit(Field{"shortest", "m", role::key}, s.shortest);
  visit(Field{"longest", "m", role::key}, s.longest);
  visit(Field{"blend_length", "m", role::key}, s.blend_length);
  visit(Field{"compression", "N s/m", role::key}, s.compression);
  visit(Field{"rebound", "N s/m", role::key}, s.rebound);
}

struct ShockSpec {
  Vec3 chassis = Vec3::Zero(), end = Vec3::Zero();  // m
  std::optional<std::string> on;                    // the part that `end` is on
  double compression = 0.0, rebound = 0.0;          // N s/m
  std::optional<OuterShockSpec> outer;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ShockSpec> auto& s) {
  visit(Field{"chassis", "m", role::key}, s.chassis);
  visit(Field{"end", "m", role::key}, s.end);
  visit(Field{"on", "", role::key}, s.on);
  visit(Field{"compression", "N s/m", role::key}, s.compression);
  visit(Field{"rebound", "N s/m", role::key}, s.rebound);
  visit(Field{"outer", "", role::key}, s.outer);
}

/// An axle under construction: vehicle/parts/suspension_kinds.hpp.
struct AxleBuild;

/// The suspension of the left side and that of the right one.
template <class Spec>
using Sides = std::array<const Spec*, 2>;

}  // namespace furrow::vehicle
