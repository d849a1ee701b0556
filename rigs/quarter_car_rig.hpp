// A quarter of a vehicle for ride: ground –prismatic (imposed speed)– trolley –vertical slider– body –vertical slider
// with spring and damper– carrier –free revolute– rim.
//
// The wheel rolls freely. With the travel s of the suspension, positive in compression, the body is pushed up by
//   F = m_b g + k s + c ṡ                                                                                      (1)
// and the carrier down. A damper between trolley and body lets the wheel down onto the ground.
#pragma once

#include <memory>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "rigs/rig.hpp"
#include "rigs/rig_keys.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`. What is negative here is open: RigSpec::mount fills it in.
struct QuarterCarOptions : RailOptions {
  double body_mass = -1.0;             // m_b, kg; in place of the load
  double unsprung_mass = -1.0;         // of the carrier, kg: what hangs under the spring beside rim and tire
  double suspension_stiffness = -1.0;  // k, N/m
  double suspension_damping = -1.0;    // c, N s/m
};
void visit_fields(auto&& visit, FieldsOf<QuarterCarOptions> auto& s) {
  visit(keys::kSpeed, s.speed);
  visit(keys::kRamp, s.ramp);
  visit(keys::kMoveFrom, s.move_from);
  visit(keys::kTouchdownTime, s.touchdown_time);
  visit(keys::kLoweringSpeed, s.lowering_speed);
  visit(keys::kStart, s.start);
  visit(keys::kLoad, s.load);
  visit(keys::kBodyMass, s.body_mass);
  visit(keys::kUnsprungMass, s.unsprung_mass);
  visit(keys::kSuspensionStiffness, s.suspension_stiffness);
  visit(keys::kSuspensionDamping, s.suspension_damping);
  visit(keys::kRimMass, s.rim_mass);
  visit(keys::kRimSpinInertia, s.rim_spin_inertia);
  visit(keys::kRimDiametralInertia, s.rim_diametral_inertia);
}

/// @pre every option is given
std::unique_ptr<Rig> make_quarter_car(const QuarterCarOptions& options);

}  // namespace furrow::rigs
