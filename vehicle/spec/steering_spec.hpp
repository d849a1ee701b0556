// What a vehicle file says of the steering of an axle. Points are in m.
#pragma once

#include <string>
#include <variant>

#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

/// An arm on the chassis and an idler carry a link between them; the tie rods' inner ends are on the link. Points are
/// from `origin` in axes that are pitched about y (x downward for a positive angle), in
/// which arm and idler turn about z.
struct PitmanArmSpec {
  static constexpr const char* kType = "pitman_arm";
  Vec3 origin = Vec3::Zero();  // in the vehicle's frame, m
  double pitch_deg = 0.0;
  BodySpec arm, link;
  Vec3 pivot = Vec3::Zero(), arm_end = Vec3::Zero();    // of the arm: on the chassis, at the link, m
  Vec3 idler = Vec3::Zero(), idler_end = Vec3::Zero();  // of the idler: on the chassis, at the link, m
  double left_angle_deg = 0.0;                          // of the arm about z, with the wheel fully to the left
  double response_time = 0.05;                          // with which it follows the steering wheel, s
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<PitmanArmSpec> auto& s) {
  visit(Field{"origin", "m", role::key}, s.origin);
  visit(Field{"pitch_deg", "deg", role::key}, s.pitch_deg);
  visit(Field{"arm", "", role::key}, s.arm);
  visit(Field{"link", "", role::key}, s.link);
  visit(Field{"pivot", "m", role::key}, s.pivot);
  visit(Field{"arm_end", "m", role::key}, s.arm_end);
  visit(Field{"idler", "m", role::key}, s.idler);
  visit(Field{"idler_end", "m", role::key}, s.idler_end);
  visit(Field{"left_angle_deg", "deg", role::key}, s.left_angle_deg);
  visit(Field{"response_time", "s", role::key | kMayMiss}, s.response_time);
}

/// A rack that slides along y in the chassis; the tie rods' inner ends are on it. Points are from the axle's origin.
struct RackSpec {
  static constexpr const char* kType = "rack";
  BodySpec rack;
  double left_travel = 0.0;     // along y with the wheel fully to the left, m
  double response_time = 0.05;  // with which it follows the steering wheel, s
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<RackSpec> auto& s) {
  visit(Field{"rack", "", role::key}, s.rack);
  visit(Field{"left_travel", "m", role::key}, s.left_travel);
  visit(Field{"response_time", "s", role::key | kMayMiss}, s.response_time);
}

using SteeringSpec = std::variant<PitmanArmSpec, RackSpec>;

}  // namespace furrow::vehicle
