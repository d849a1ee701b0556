// What a tire did on hard ground at many slips and loads, as `furrow sweep` tables it:
// what a handling tire is fitted to.
//
// Columns, by the names of sweep.csv: iso_w.force_N.0 to .2, iso_w.moment_Nm.0 to .2, iso_w.slip_angle_rad,
// iso_w.camber_angle_rad, iso_w.loaded_radius_m, effective_rolling_radius_m (V/Ω) and rig.mode; others are passed over,
// and so are rows whose `state` is not done. The slip counts from free rolling at the same load,
//
//   κ = R_e(F_z)/(V/Ω) − 1,
//
// R_e from the rows that roll freely, straight and upright, on straight lines between their loads and beyond. A wheel
// that rolls freely has no slip, also where it is turned or leans: the formula's R_e knows the load alone.
#pragma once

#include <filesystem>
#include <vector>

#include "tire/handling/magic_formula.hpp"

namespace furrow::tire::handling {

struct SweepPoint {
  SlipState state;              // its speed is 0: not said
  HandlingForces forces;        // without stiffnesses
  double loaded_radius = 0.0;   // m
  double rolling_radius = 0.0;  // V/Ω, m
  bool rolls_freely = false;    // straight and upright
};

/// @throws Error(bad_input) naming file and line
std::vector<SweepPoint> read_sweep_table(const std::filesystem::path& file);

}  // namespace furrow::tire::handling
