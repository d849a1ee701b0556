// How densely a bed is packed: `terrain.solid_fraction`.
//
// Grains of a given friction have a range of packings that stay as they are. Its dense end comes from grains that are
// smoother while they fall, its loose end from grains that come down slowly, one at a time [Agnolin & Roux 2007,
// doi:10.1103/PhysRevE.76.061302; Onoda & Liniger 1990, doi:10.1103/PhysRevLett.64.2727]. Both leave a bed in balance
// with the friction of the run: more friction only helps it, and a drag vanishes with the motion. What holds a bed up
// beyond that while it settles (more friction, cohesion) gives nothing: it falls in when that goes, to the same loose
// end or denser.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

inline constexpr double kLoosestDrag = 2.0;  // settling_drag beyond which beds hardly become looser
inline constexpr double kMetastable = 0.52;  // looser beds: a shock or more weight can make them fall in
inline constexpr double kPackingTolerance = 0.003, kLooseTolerance = 0.006;

/// How far the solid fraction of a bed may be from the one asked for.
double packing_tolerance(double solid_fraction);

/// From −1, settled without friction and cohesion, over 0, as the grains are, to 1, settled under kLoosestDrag.
DemOptions laid(DemOptions options, double looseness);

/// Drag of falling grains of the bed, 1/s.
double fall_drag(const DemOptions& options);

/// A small bed of the same grains, as deep, with periodic sides: what packings are tried on.
DemOptions sample_of(const DemOptions& options);

/// Finds the looseness that gives a solid fraction, by the fractions of beds that `solid_fraction` makes.
class PackingSearch {
 public:
  explicit PackingSearch(std::function<double(double looseness)> solid_fraction)
      : solid_fraction_(std::move(solid_fraction)) {}

  /// The best of at most kMostTries more beds; the end of the range where the fraction is beyond it.
  double looseness_for(double solid_fraction);
  /// Of that bed, which is made if it is not known.
  double at(double looseness);
  /// By how much denser a bed is for so much less looseness, on that side of 0.
  double slope(double looseness) { return looseness > 0.0 ? at(0.0) - at(1.0) : at(-1.0) - at(0.0); }
  double loosest() { return at(1.0); }
  double densest() { return at(-1.0); }

 private:
  std::function<double(double)> solid_fraction_;
  std::map<double, double> known_;  // solid fractions by looseness
};

/// @throws Error(bad_input) for keys that contradict each other
void check_packing(const DemOptions& options);

}  // namespace furrow::terrain::dem
