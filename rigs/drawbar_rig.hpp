// Single-tire drawbar-pull rig: ground –prismatic (imposed speed)– chassis –imposed toe angle– set-toe
// –vertical slider– wheel carrier (ballast) –driven revolute (imposed angular speed)– rim. Slip s = 1 − v/(ω
// r), r the undeformed tire radius.
#pragma once

#include <memory>

#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "rigs/rig.hpp"

namespace furrow::rigs {

/// Every field but the gravity is the scenario key `rig.<name>`; `lateral` is that of an entry of `rig.wheels`. What is
/// negative here is open: RigSpec::mount fills it in from the tire (drawbar_mount.hpp), and a rig is made of given
/// values alone.
struct DrawbarRigOptions {
  std::string mode = "fixed_angular_speed";  // fixed_angular_speed: ω given, v = ω r (1 − s)
                                             // fixed_speed: v given, ω = v / (r (1 − s))
                                             // free_rolling: v given, no spindle torque, ω free
  double slip = 0.3;                         // -, below 1 for fixed_speed
  double angular_speed = 8.56;               // rad/s
  double speed = 4.0;                        // carriage speed, m/s, modes fixed_speed and free_rolling
  double ramp = 0.15;               // smooth (C²) ramp of both motions from rest, s; 0: from t = 0 at full speed
  double move_from = 0.0;           // when both motions begin, s: until then the wheel is lowered and stands
  double touchdown_damping = -1.0;  // N s/m, vertical damper between set-toe and carrier
  double touchdown_time = -1.0;     // s, how long it acts
  double lowering_speed = -1.0;     // m/s, at which that damper lets the load down; in place of its constant
  double toe_angle = 0.0;           // rad, about +z
  double toe_time = 0.0;            // s, when the wheel is turned from 0 to toe_angle; 0: it stands so from the start
  double toe_ramp = 0.01;           // s, how long that takes
  double camber_angle = 0.0;        // rad, about the wheel's forward axis: positive leans the top to the right
  double travel_sign = 1.0;         // +1 along +x, −1 along −x (mirrored travel)
  double start = 0.0;               // x of the axle at t = 0, m; where the scenario does not say it, it is filled in
  double lateral = 0.0;             // y of the wheel's mid-plane, m
  double load = -1.0;               // weight of all that the ground carries, tire included, N
  double carrier_mass = -1.0;       // wheel carrier with ballast, kg; in place of the load
  double chassis_mass = 1.0;        // kg, rides on the rail
  double set_toe_mass = 1.0;        // kg, rides on the rail
  double rim_mass = -1.0;           // kg
  double rim_spin_inertia = -1.0;   // kg m², about the axle
  double rim_diametral_inertia = -1.0;  // kg m²
  Vec3 gravity = standard_gravity();    // m/s²
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DrawbarRigOptions> auto& s) {
  visit(Field{"mode", "", role::key}, s.mode);
  visit(Field{"slip", "-", role::key}, s.slip);
  visit(Field{"angular_speed", "rad/s", role::key}, s.angular_speed);
  visit(Field{"speed", "m/s", role::key}, s.speed);
  visit(Field{"ramp", "s", role::key}, s.ramp);
  visit(Field{"move_from", "s", role::key}, s.move_from);
  visit(Field{"touchdown_damping", "N s/m", role::key}, s.touchdown_damping);
  visit(Field{"touchdown_time", "s", role::key}, s.touchdown_time);
  visit(Field{"lowering_speed", "m/s", role::key}, s.lowering_speed);
  visit(Field{"toe_angle", "rad", role::key}, s.toe_angle);
  visit(Field{"toe_time", "s", role::key}, s.toe_time);
  visit(Field{"toe_ramp", "s", role::key}, s.toe_ramp);
  visit(Field{"camber_angle", "rad", role::key}, s.camber_angle);
  visit(Field{"travel_sign", "", role::key}, s.travel_sign);
  visit(Field{"start", "m", role::key}, s.start);
  visit(Field{"lateral", "m"}, s.lateral);
  visit(Field{"load", "N", role::key}, s.load);
  visit(Field{"carrier_mass", "kg", role::key}, s.carrier_mass);
  visit(Field{"chassis_mass", "kg", role::key}, s.chassis_mass);
  visit(Field{"set_toe_mass", "kg", role::key}, s.set_toe_mass);
  visit(Field{"rim_mass", "kg", role::key}, s.rim_mass);
  visit(Field{"rim_spin_inertia", "kg m²", role::key}, s.rim_spin_inertia);
  visit(Field{"rim_diametral_inertia", "kg m²", role::key}, s.rim_diametral_inertia);
}

std::unique_ptr<Rig> make_drawbar_rig(const DrawbarRigOptions& options);

/// The same, until a stop takes hold of the vertical slider where the wheel then stands on its load. What speed the
/// slider still has ends in the stop. @param hold_axle_from s, at touchdown_time or later
std::unique_ptr<Rig> make_held_drawbar_rig(const DrawbarRigOptions& options, double hold_axle_from);

}  // namespace furrow::rigs
