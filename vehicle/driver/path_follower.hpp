// Steers along a path by one of three laws. The vehicle has the wheelbase L, and δ is the angle of its front wheels:
//
//   pure_pursuit  [Coulter 1992]: the rear axle's circle, tangential to the vehicle, goes through the point ahead on
//                 the path at the distance D = max(D₀, t v, √2 |e|) from the rear axle. y is this point's distance to
//                 the left of the vehicle's axis.
//                   κ = 2 y/D²,  tan δ = L κ
//   stanley       [Hoffmann et al. 2007], with front axle, heading error ψ and distance e left of the path; k_s is
//                 their softening for low speeds. Their damping terms are left out.
//                   δ = −ψ − arctan(k e/(k_s + |v|))
//   preview       feedforward of the path's curvature and feedback of the rear axle's error, after [Kapania & Gerdes
//                 2015], eq. (4), (6) and §4: κ_p at the distance t_p |v| ahead, a mean over up to ±L/4, with the
//                 understeer gradient K. The heading error ψ is compared with the rear axle's slip angle S v² κ_h on a
//                 curve of κ_h, halfway there. k_r damps the yaw rate r as in [Hoffmann et al. 2007].
//                   δ = atan(L (κ_p − (e + 2 d sin(ψ − S v² κ_h))/d²)) + K v² κ_p − k_r (r − v κ_h),
//                       d = max(d₀, t_r |v|)
//                 Small errors of a kinematic vehicle decay critically damped in the distance d, (1 + s/d) e^(−s/d).
//                 Larger e counts as √2 d, so that the vehicle comes back at 45°.
//
// Cross-track error e is measured at the axle that the law uses. D grows with |e|, so that a vehicle far off the path
// comes back at 45°. The steering follows the law's value with a bounded rate.
//
// R. C. Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01, Carnegie Mellon
// University 1992.
// G. M. Hoffmann, C. J. Tomlin, M. Montemerlo, S. Thrun, Autonomous Automobile Trajectory Tracking for Off-Road
// Driving, American Control Conference 2007, 2296–2301, doi:10.1109/ACC.2007.4282788.
// N. R. Kapania, J. C. Gerdes, Design of a feedback-feedforward steering controller for accurate path tracking and
// stability at the limits of handling, Vehicle System Dynamics 53 (12), 2015, 1687–1704,
// doi:10.1080/00423114.2015.1055279.
#pragma once

#include "protocol/core/fields.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/driver/path.hpp"

namespace furrow::vehicle {

struct PathState {
  bool begun = false;     // whether there was a call before
  double time = 0.0;      // of the last call, s
  double steering = 0.0;  // then
  PathPlace place;        // reached by the axle; never moves back
};
void visit_fields(FieldsOf<PathState> auto& s, auto&& visit) {
  visit(s.begun, Field{"begun", ""});
  visit(s.time, Field{"time", "s"});
  visit(s.steering, Field{"steering"});
  visit(s.place, Field{"place", ""});
}

class PathFollower {
 public:
  PathFollower(const PathSpec& spec, const DriverCar& car);

  /// Sets the steering and the record's values of the path. @pre view.time ≥ state.time
  void steer(const DriverView& view, PathState& state, DriverRecord& record) const;

 private:
  double wheel_angle(const PurePursuit& law, const DriverView& view, const PathPlace& place,
                     const DriverRecord& record) const;  // δ, rad
  double wheel_angle(const Stanley& law, const DriverView& view, const PathPlace& place,
                     const DriverRecord& record) const;
  double wheel_angle(const Preview& law, const DriverView& view, const PathPlace& place,
                     const DriverRecord& record) const;

  Path path_;
  PathSteeringSpec spec_;
  DriverCar car_;
};

}  // namespace furrow::vehicle
