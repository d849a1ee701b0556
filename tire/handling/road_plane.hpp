// The plane that a handling tire meets where the ground is not level: tangent to the mean of its heights h over the
// contact, taken at the contact centre C,
//
//   H(x, y) = ∫∫ h dξ dη/(4ab),   ∂H/∂ξ = ∫ [h(ξ + a) − h(ξ − a)] dη/(4ab),   ∂H/∂η likewise                   (1)
//
// with ξ along and η across the wheel, a half the length of the contact under the nominal load, b half the width. So
// heights and slopes are those of one surface, and a spring that stands on it at C makes no energy. It is an effective
// road plane [Pacejka 2012, 9.3.2] without the shape of an obstacle: waves much longer than 2a are followed, shorter
// ones are averaged, and a step is a ramp of the length 2a. The integrals are Simpson's, of 5 heights along and 3
// across.
//
// [Pacejka 2012] H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, chapter 9.
#pragma once

#include "protocol/core/ground_heights.hpp"
#include "tire/wheel_axes.hpp"

namespace furrow::tire::handling {

class RoadPlane {
 public:
  /// Level: z = 0.
  RoadPlane() = default;
  /// @pre half_length > 0, half_width > 0, m
  RoadPlane(GroundHeights heights, double half_length, double half_width);

  /// The W-axes of a wheel on it. @param radius undeformed, m @param travel as of wheel_axes()
  WheelAxes axes_of(const RimState& rim, const Vec3& travel, double radius) const;

 private:
  /// (1) @param along horizontal, unit
  GroundPlane at(double x, double y, const Vec3& along) const;

  GroundHeights heights_;
  double half_length_ = 0.0, half_width_ = 0.0;
};

}  // namespace furrow::tire::handling
