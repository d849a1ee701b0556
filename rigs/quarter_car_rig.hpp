// A quarter of a vehicle for ride: ground –prismatic (imposed speed)– trolley –vertical slider– body –vertical slider
// with spring and damper– carrier –free revolute– rim.
//
// The wheel rolls freely. With the travel s of the suspension, positive in compression, the body is pushed up by
//   F = m_b g + k s + c ṡ                                                                                      (1)
// and the carrier is pushed down. A damper between trolley and body lowers the wheel onto the ground.
#pragma once

#include <memory>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "rigs/rig.hpp"
#include "rigs/rig_keys.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`. A negative value is open: RigSpec::mount fills it in.
struct QuarterCarOptions : RailOptions {
  double body_mass = -1.0;             // m_b, kg; instead of the load
  double unsprung_mass = -1.0;         // of the carrier, kg: all unsprung mass but rim and tire
  double suspension_stiffness = -1.0;  // k, N/m
  double suspension_damping = -1.0;    // c, N s/m
};
void visit_fields(FieldsOf<QuarterCarOptions> auto& s, auto&& visit) {
  visit(s.speed, keys::kSpeed);
  visit(s.ramp, keys::kRamp);
  visit(s.move_from, keys::kMoveFrom);
  visit(s.touchdown_time, keys::kTouchdownTime);
  visit(s.lowering_speed, keys::kLoweringSpeed);
  visit(s.start, keys::kStart);
  visit(s.load, keys::kLoad);
  visit(s.body_mass, keys::kBodyMass);
  visit(s.unsprung_mass, keys::kUnsprungMass);
  visit(s.suspension_stiffness, keys::kSuspensionStiffness);
  visit(s.suspension_damping, keys::kSuspensionDamping);
  visit(s.rim_mass, keys::kRimMass);
  visit(s.rim_spin_inertia, keys::kRimSpinInertia);
  visit(s.rim_diametral_inertia, keys::kRimDiametralInertia);
}

/// @pre every option is given
std::unique_ptr<Rig> make_quarter_car(const QuarterCarOptions& options);

}  // namespace furrow::rigs
