// Half of a vehicle for ride: ground –prismatic (imposed speed)– trolley –vertical slider– hub –hinge about y– body.
// For each of two wheels, front and rear: trolley –vertical slider– carrier –free revolute– rim, with spring and damper
// between carrier and body.
//
// The wheels roll freely. The trolley pulls them along, so only the suspensions pitch the body. With the travel s of a
// suspension, positive in compression, the body is pushed up above the axle by
//   F = W + k s + c ṡ                                                                                          (1)
// and the carrier is pushed down; W is the body's weight there. The struts are 1 m long and upright at rest. Because
// (1) acts along them, the rig is linear in heights and pitch except for terms of third order. The hub has a hundredth
// of the body's mass and sits in its centre. A damper between trolley and hub lowers the wheels onto the ground.
#pragma once

#include <memory>

#include "protocol/core/column.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "rigs/quarter_car_rig.hpp"
#include "rigs/rig.hpp"
#include "rigs/rig_keys.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`. A negative value is open: RigSpec::mount fills it in.
struct HalfCarOptions : QuarterCarOptions {
  double wheelbase = 2.7;                   // a + b, m
  double front_share = 0.5;                 // of the body's weight, on the front wheel: b/(a + b)
  double pitch_inertia = -1.0;              // J of the body about its centre, kg m²
  double rear_suspension_stiffness = -1.0;  // k of the rear, N/m
  double rear_suspension_damping = -1.0;    // c of the rear, N s/m
};
void visit_fields(FieldsOf<HalfCarOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.speed, keys::kSpeed);
  visit(s.ramp, keys::kRamp);
  visit(s.move_from, keys::kMoveFrom);
  visit(s.touchdown_time, keys::kTouchdownTime);
  visit(s.lowering_speed, keys::kLoweringSpeed);
  visit(s.start, keys::kStart);
  visit(s.wheelbase, key("wheelbase", "m", above(0).to(1e3).usual(0.1, 20),
                         "Distance of the rear axle of a half car behind its front axle."));
  visit(s.front_share,
        key("front_share", "-", above(0).below(1).usual(0.2, 0.8),
            "Share of a half car's body weight on its front wheel at rest: distance of the rear axle from the body's "
            "centre over the wheelbase."));
  visit(s.load, keys::kLoad);
  visit(s.body_mass, keys::kBodyMass);
  visit(s.pitch_inertia,
        key("pitch_inertia", "kg m²", above(0).to(1e8).usual(0.1, 1e5).or_null(),
            "Moment of inertia of a half car's body about the lateral axis through its centre. null: body_mass times "
            "the distances of both axles from the centre, by which front and rear do not feel each other."));
  visit(s.unsprung_mass, keys::kUnsprungMass);
  visit(s.suspension_stiffness, keys::kSuspensionStiffness);
  visit(s.suspension_damping, keys::kSuspensionDamping);
  visit(s.rear_suspension_stiffness,
        key("rear_suspension_stiffness", "N/m", from(0, 1e9).usual(10, 1e6).or_null(),
            "Spring between body and rear wheel of a half car. null: suspension_stiffness in proportion to the body "
            "weights that the wheels bear."));
  visit(s.rear_suspension_damping,
        key("rear_suspension_damping", "N s/m", from(0, 1e8).usual(0.1, 1e5).or_null(),
            "Damper between body and rear wheel of a half car. null: suspension_damping in proportion to the body "
            "weights that the wheels bear."));
  visit(s.rim_mass, keys::kRimMass);
  visit(s.rim_spin_inertia, keys::kRimSpinInertia);
  visit(s.rim_diametral_inertia, keys::kRimDiametralInertia);
}

/// The body's own table (subject `body`).
struct HalfCarBodyRow {
  double height = 0.0;              // of the centre, above where it was placed, m
  double acceleration = 0.0;        // of the centre, upwards, m/s²
  double pitch = 0.0;               // nose down, rad
  double pitch_acceleration = 0.0;  // rad/s²
  double drive_force = 0.0;         // of the drive that keeps the trolley at its speed, N
};
void visit_fields(FieldsOf<HalfCarBodyRow> auto& r, auto&& visit) {
  using namespace column;
  visit(r.height, instant("body_height_m", "m"));
  visit(r.acceleration, mean("body_acceleration_m_per_s2", "m/s²"));
  visit(r.pitch, instant("pitch_rad", "rad"));
  visit(r.pitch_acceleration, mean("pitch_acceleration_rad_per_s2", "rad/s²"));
  visit(r.drive_force, mean("trolley_force_N", "N"));
}

/// @pre every option is given
std::unique_ptr<Rig> make_half_car(const HalfCarOptions& options);

}  // namespace furrow::rigs
