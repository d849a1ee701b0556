// Packing of a bed: `terrain.solid_fraction`.
//
// Grains of a given friction have a range of stable packings. Its dense end comes from grains that are smoother while
// they fall, its loose end from grains that come down slowly, one at a time [Agnolin & Roux 2007,
// doi:10.1103/PhysRevE.76.061302; Onoda & Liniger 1990, doi:10.1103/PhysRevLett.64.2727]. Both leave a bed in balance
// with the friction of the run: more friction only supports it, and a drag vanishes with the motion. Other support
// during settling (more friction, cohesion) is useless: when it ends, the bed collapses to the same loose end or
// denser.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

inline constexpr double kLoosestDrag = 2.0;  // beds hardly become looser with a larger settling_drag
inline constexpr double kMetastable = 0.52;  // a shock or more weight can make looser beds collapse
inline constexpr double kPackingTolerance = 0.003, kLooseTolerance = 0.006;

/// Largest deviation of a bed's solid fraction from the prescribed one.
double packing_tolerance(double solid_fraction);

/// Options for a looseness: −1 settles without friction and cohesion, 0 as the grains are, 1 under kLoosestDrag.
DemOptions laid(DemOptions options, double looseness);

/// Drag of falling grains of the bed, 1/s.
double fall_drag(const DemOptions& options);

/// A small bed of the same grains, of the same depth, with periodic sides, on which packings are tried.
DemOptions sample_of(const DemOptions& options);

/// Finds the looseness that gives a solid fraction, from beds whose fraction the call `solid_fraction` returns.
class PackingSearch {
 public:
  explicit PackingSearch(std::function<double(double looseness)> solid_fraction)
      : solid_fraction_(std::move(solid_fraction)) {}

  /// The best after at most kMostTries more beds; the end of the range if the fraction is beyond it.
  double looseness_for(double solid_fraction);
  /// Solid fraction of the bed with that looseness, which is made if it is not known.
  double at(double looseness);
  /// Decrease of the solid fraction per looseness, on that side of 0.
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
