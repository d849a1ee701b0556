// A quarter of a vehicle for ride: ground –prismatic (imposed speed)– trolley –vertical slider– body –vertical slider
// with spring and damper– carrier –free revolute– rim.
//
// The wheel rolls freely. With the travel s of the suspension, positive in compression, the body is pushed up by
//   F = m_b g + k s + c ṡ                                                                                      (1)
// and the carrier down. A damper between trolley and body lets the wheel down onto the ground.
#pragma once

#include <memory>

#include "protocol/core/fields.hpp"
#include "rigs/rig.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`. What is negative here is open: RigSpec::mount fills it in.
struct QuarterCarOptions {
  double speed = 4.0;                  // of the trolley, m/s
  double ramp = 0.15;                  // smooth (C²) start from rest, s; 0: full speed from t = 0
  double move_from = 0.0;              // when it starts, s
  double touchdown_time = -1.0;        // how long the damper lets the wheel down, s
  double lowering_speed = -1.0;        // m/s, at which it does
  double start = 0.0;                  // x of the axle at t = 0, m; where the scenario does not say it, it is filled in
  double load = -1.0;                  // weight of all that the ground carries, N
  double body_mass = -1.0;             // m_b, kg; in place of the load
  double unsprung_mass = -1.0;         // of the carrier, kg: what hangs under the spring beside rim and tire
  double suspension_stiffness = -1.0;  // k, N/m
  double suspension_damping = -1.0;    // c, N s/m
  double rim_mass = -1.0;              // kg
  double rim_spin_inertia = -1.0;      // kg m², about the axle
  double rim_diametral_inertia = -1.0;  // kg m²
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<QuarterCarOptions> auto& s) {
  visit(Field{"speed", "m/s", role::key}, s.speed);
  visit(Field{"ramp", "s", role::key}, s.ramp);
  visit(Field{"move_from", "s", role::key}, s.move_from);
  visit(Field{"touchdown_time", "s", role::key}, s.touchdown_time);
  visit(Field{"lowering_speed", "m/s", role::key}, s.lowering_speed);
  visit(Field{"start", "m", role::key}, s.start);
  visit(Field{"load", "N", role::key}, s.load);
  visit(Field{"body_mass", "kg", role::key}, s.body_mass);
  visit(Field{"unsprung_mass", "kg", role::key}, s.unsprung_mass);
  visit(Field{"suspension_stiffness", "N/m", role::key}, s.suspension_stiffness);
  visit(Field{"suspension_damping", "N s/m", role::key}, s.suspension_damping);
  visit(Field{"rim_mass", "kg", role::key}, s.rim_mass);
  visit(Field{"rim_spin_inertia", "kg m²", role::key}, s.rim_spin_inertia);
  visit(Field{"rim_diametral_inertia", "kg m²", role::key}, s.rim_diametral_inertia);
}

/// @pre every option is given
std::unique_ptr<Rig> make_quarter_car(const QuarterCarOptions& options);

}  // namespace furrow::rigs
