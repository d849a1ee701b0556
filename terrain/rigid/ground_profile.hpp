// Hard ground that is not level: a profile z(x), alike for all y, with faces that may stand upright (a curb).
//
// The ground is an elastic layer under a skin of this shape. At a point inside it the layer bears the pressure κ d,
// d the distance to the skin, against the surface that is there: a pressure field that is fixed in the ground [Elandt
// et al. 2019]. So the contact has an energy, the integral of κ d over the volume that surface and ground share,
//   E = κ ∫ d dV = κ ∮ I (−n_z) dA,   I(x, z) = ∫_z^{top} d dz',                                              (1)
// and its forces are those of (1) under any motion in x and z. A sharp edge sinks in until its two sides bear.
//
// R. Elandt, E. Drumwright, M. Sherman, A. Ruina, A pressure field model for fast, robust approximation of net contact
// force and moment between nominally rigid objects, IROS 2019, doi:10.1109/IROS40897.2019.8968548.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "protocol/core/ground_heights.hpp"

namespace furrow::terrain {

/// Height z (m) at x (m), one entry [x, z] for each corner.
using ProfilePoints = GroundProfilePoints;

/// What is wrong with the last of some points, if anything.
enum class ProfileFault { none, goes_back, repeated, third_at_one_x };
ProfileFault fault_of(const ProfilePoints& points, std::size_t last);

/// @throws Error(bad_input) naming file and key where x decreases, two entries are alike, or more than two have one x
void check_profile(const ProfilePoints& points, const std::string& file, const std::string& key);

/// The least x and the most between which the heights change, m; none change: NaN.
std::array<double, 2> uneven_range(const ProfilePoints& points);

class GroundProfile {
 public:
  /// Straight between the points, level before the first and after the last; none: the plane z = 0.
  /// @pre check_profile() holds
  explicit GroundProfile(const ProfilePoints& points);

  /// Of an upright face its top.
  double height(double x) const;
  double highest(double from, double to) const;
  double mean(double from, double to) const;  // @pre from ≤ to
  /// d of a point, m; 0 where it is not in the ground.
  double depth(double x, double z) const;
  /// I of (1), m²; 0 where the point is not in the ground.
  double column(double x, double z) const;
  /// Whether the ground is level from x `from` to `to` and as far beyond as `deep` reaches.
  bool level(double from, double to, double deep) const;

  double first() const { return points_.front()[0]; }  // x of the first corner, m
  double last() const { return points_.back()[0]; }

 private:
  double distance(double x, double z, double most) const;
  std::size_t first_at(double x) const;  // number of the first point whose x is not less

  ProfilePoints points_;
};

}  // namespace furrow::terrain
