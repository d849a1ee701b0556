// The steering of an axle in a vehicle file. Points are in m.
#pragma once

#include <string>
#include <variant>

#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

/// An arm on the chassis and an idler carry a link between them; the tie rods' inner ends are on the link. Points are
/// relative to `origin` in axes that are pitched about y (x downward for a positive angle); arm and idler turn about z
/// of these axes.
struct PitmanArmSpec {
  static constexpr SchemaName kSchema{"pitman_arm",
                                      "An arm and an idler on the chassis with a link between them. Points are from "
                                      "origin, in axes pitched about y, in m."};
  static constexpr const char* kType = "pitman_arm";
  Vec3 origin = Vec3::Zero();  // in the vehicle's frame, m
  double pitch_deg = 0.0;
  BodySpec arm, link;
  Vec3 pivot = Vec3::Zero(), arm_end = Vec3::Zero();    // of the arm: on the chassis, at the link, m
  Vec3 idler = Vec3::Zero(), idler_end = Vec3::Zero();  // of the idler: on the chassis, at the link, m
  double left_angle_deg = 0.0;                          // of the arm about z, with the wheel fully to the left
  double response_time = 0.05;                          // with which it follows the steering wheel, s
};
void visit_fields(FieldsOf<PitmanArmSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.origin, needed("origin", "m", keys::kPoint, "Origin of the linkage in the vehicle's frame."));
  visit(s.pitch_deg,
        needed("pitch_deg", "deg", from(-90, 90), "Turn of the linkage's axes about y; positive: x points downward."));
  visit(s.arm, needed("arm"));
  visit(s.link, needed("link"));
  visit(s.pivot, needed("pivot", "m", keys::kPoint, "Pivot of the pitman arm on the chassis."));
  visit(s.arm_end, needed("arm_end", "m", keys::kPoint, "Joint of the pitman arm with the link."));
  visit(s.idler, needed("idler", "m", keys::kPoint, "Pivot of the idler arm on the chassis."));
  visit(s.idler_end, needed("idler_end", "m", keys::kPoint, "Joint of the idler arm with the link."));
  visit(s.left_angle_deg, needed("left_angle_deg", "deg", above(-90).below(90),
                                 "Angle of the pitman arm about z with the wheel fully to the left; not 0."));
  visit(s.response_time, keys::kResponseTime);
}

/// A rack that slides along y in the chassis; the tie rods' inner ends are on it. Points are relative to the axle's
/// origin.
struct RackSpec {
  static constexpr SchemaName kSchema{"rack", "A rack that slides along y."};
  static constexpr const char* kType = "rack";
  BodySpec rack;
  double left_travel = 0.0;     // along y with the wheel fully to the left, m
  double response_time = 0.05;  // with which it follows the steering wheel, s
};
void visit_fields(FieldsOf<RackSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.rack, needed("rack"));
  visit(s.left_travel, needed("left_travel", "m", from(-10, 10),
                              "Travel of the rack along y with the steering wheel fully to the left; not 0."));
  visit(s.response_time, keys::kResponseTime);
}

using SteeringSpec = std::variant<PitmanArmSpec, RackSpec>;

}  // namespace furrow::vehicle
