// Single-tire drawbar-pull rig: ground –prismatic (imposed speed)– chassis –imposed toe angle– set-toe
// –vertical slider– wheel carrier (ballast) –driven revolute (imposed angular speed)– rim. Slip s = 1 − v/(ω
// r), r the undeformed tire radius.
#pragma once

#include <memory>

#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "rigs/rig.hpp"
#include "rigs/rig_keys.hpp"

namespace furrow::rigs {

/// Every field but the gravity is the scenario key `rig.<name>`; `lateral` is a key of an entry of `rig.wheels`. A
/// negative value is open: RigSpec::mount fills it in from the tire (drawbar_mount.hpp). A rig is made only when every
/// value is given.
struct DrawbarRigOptions : RailOptions {
  std::string mode = "fixed_angular_speed";  // fixed_angular_speed: ω given, v = ω r (1 − s)
                                             // fixed_speed: v given, ω = v / (r (1 − s))
                                             // free_rolling: v given, no spindle torque, ω free
  double slip = 0.3;                         // -, below 1 for fixed_speed
  double angular_speed = 8.56;               // rad/s
  double touchdown_damping = -1.0;           // N s/m, vertical damper between set-toe and carrier
  double toe_angle = 0.0;                    // rad, about +z
  double toe_time = 0.0;              // s, when the wheel turns from 0 to toe_angle; 0: it has toe_angle from the start
  double toe_ramp = 0.01;             // s, how long this turn takes
  double camber_angle = 0.0;          // rad, about the wheel's forward axis: positive leans the top to the right
  double travel_sign = 1.0;           // +1 along +x, −1 along −x (mirrored travel)
  double lateral = 0.0;               // y of the wheel's mid-plane, m
  double carrier_mass = -1.0;         // wheel carrier with ballast, kg; instead of the load
  double chassis_mass = 1.0;          // kg, rides on the rail
  double set_toe_mass = 1.0;          // kg, rides on the rail
  Vec3 gravity = standard_gravity();  // m/s²
};

void visit_fields(FieldsOf<DrawbarRigOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.mode,
        key("mode", "", words("fixed_angular_speed fixed_speed free_rolling"),
            "What is imposed. fixed_angular_speed: the carriage moves at v = angular_speed · R · (1 − slip). "
            "fixed_speed: the wheel turns at ω = speed / (R · (1 − slip)). free_rolling: the speed is imposed, and "
            "there is no spindle torque."));
  visit(s.slip,
        key("slip", "-", from(-10, 1),
            "Slip 1 − v/(ω R), R the undeformed tire radius. It is below 1 in mode fixed_speed. A braking slip of −0.2 "
            "by the definition ω R/v − 1 is −0.25 here."));
  visit(s.angular_speed,
        key("angular_speed", "rad/s", from(0, 1000).usual(0.1, 100), "Spin of the wheel, mode fixed_angular_speed."));
  visit(s.speed, keys::kSpeed);
  visit(s.ramp, keys::kRamp);
  visit(s.move_from, keys::kMoveFrom);
  visit(s.touchdown_damping,
        key("touchdown_damping", "N s/m", from(0, 1e7).or_null(),
            "Coefficient of the vertical damper on the slider while the tire touches down. null: the load over "
            "lowering_speed."));
  visit(s.touchdown_time, keys::kTouchdownTime);
  visit(s.lowering_speed, keys::kLoweringSpeed);
  visit(s.toe_angle,
        key("toe_angle", "rad", from(-1.5, 1.5).usual(-0.5, 0.5), "Angle between wheel plane and travel, about +z."));
  visit(s.toe_time,
        key("toe_time", "s", from(0, 1e5),
            "When the wheel turns from straight ahead to toe_angle: a step of the slip angle. 0: it has toe_angle from "
            "the start."));
  visit(s.toe_ramp, key("toe_ramp", "s", above(0).to(1e4), "How long the turn at toe_time takes; it is smooth."));
  visit(s.camber_angle,
        key("camber_angle", "rad", from(-0.7, 0.7).usual(-0.3, 0.3),
            "Inclination of the wheel about its forward axis. A positive one leans the top to the right of travel."));
  visit(s.travel_sign, key("travel_sign", "", shaped(R"({"type": "integer", "enum": [1, -1]})"),
                           "Direction of travel. 1: along +x. -1: along −x."));
  visit(s.start, keys::kStart);
  visit(s.lateral, Field{"lateral", "m"});
  visit(s.load, keys::kLoad);
  visit(s.carrier_mass, keys::kCarrierMass);
  visit(s.chassis_mass, key("chassis_mass", "kg", above(0).to(1e6),
                            "Mass that the rail carries, not the soil: the chassis of the rig."));
  visit(s.set_toe_mass, key("set_toe_mass", "kg", above(0).to(1e6),
                            "Mass that the rail carries, not the soil: the part that sets the toe angle."));
  visit(s.rim_mass, keys::kRimMass);
  visit(s.rim_spin_inertia, keys::kRimSpinInertia);
  visit(s.rim_diametral_inertia, keys::kRimDiametralInertia);
}

std::unique_ptr<Rig> make_drawbar_rig(const DrawbarRigOptions& options);

/// Makes a drawbar rig whose vertical slider a stop holds from `hold_axle_from` on, at the height where the wheel then
/// rests. The stop takes up any speed that the slider still has. @param hold_axle_from s, at touchdown_time or later
std::unique_ptr<Rig> make_held_drawbar_rig(const DrawbarRigOptions& options, double hold_axle_from);

}  // namespace furrow::rigs
