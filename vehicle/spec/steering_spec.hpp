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
void visit_fields(auto&& visit, FieldsOf<PitmanArmSpec> auto& s) {
  using namespace allowed;
  visit(needed("origin", "m", keys::kPoint, "Origin of the linkage in the vehicle's frame."), s.origin);
  visit(needed("pitch_deg", "deg", from(-90, 90), "Turn of the linkage's axes about y; positive: x points downward."),
        s.pitch_deg);
  visit(needed("arm"), s.arm);
  visit(needed("link"), s.link);
  visit(needed("pivot", "m", keys::kPoint, "Pivot of the pitman arm on the chassis."), s.pivot);
  visit(needed("arm_end", "m", keys::kPoint, "Joint of the pitman arm with the link."), s.arm_end);
  visit(needed("idler", "m", keys::kPoint, "Pivot of the idler arm on the chassis."), s.idler);
  visit(needed("idler_end", "m", keys::kPoint, "Joint of the idler arm with the link."), s.idler_end);
  visit(needed("left_angle_deg", "deg", above(-90).below(90),
               "Angle of the pitman arm about z with the wheel fully to the left; not 0."),
        s.left_angle_deg);
  visit(keys::kResponseTime, s.response_time);
}

/// A rack that slides along y in the chassis; the tie rods' inner ends are on it. Points are from the axle's origin.
struct RackSpec {
  static constexpr SchemaName kSchema{"rack", "A rack that slides along y."};
  static constexpr const char* kType = "rack";
  BodySpec rack;
  double left_travel = 0.0;     // along y with the wheel fully to the left, m
  double response_time = 0.05;  // with which it follows the steering wheel, s
};
void visit_fields(auto&& visit, FieldsOf<RackSpec> auto& s) {
  using namespace allowed;
  visit(needed("rack"), s.rack);
  visit(needed("left_travel", "m", from(-10, 10),
               "Travel of the rack along y with the steering wheel fully to the left; not 0."),
        s.left_travel);
  visit(keys::kResponseTime, s.response_time);
}

using SteeringSpec = std::variant<PitmanArmSpec, RackSpec>;

}  // namespace furrow::vehicle
