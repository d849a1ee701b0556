// Parameters and coefficients of the grain solver from the options of a scenario.
#pragma once

#include <string>

#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

inline constexpr double kSkinShare = 0.2;  // skin of the neighbour list over the radius

/// @throws Error(bad_input) listing the valid names.
Precision precision_from(const std::string& name);

SolverParams solver_params(const DemOptions& options);
/// Parameters for making a bed: with its own number of threads, and no grain sleeps.
SolverParams settling_params(const DemOptions& options);
/// Coefficients of a run with this step, s: walls are of the grains' material.
SolverCoefficients run_coefficients(const DemOptions& options, double step);
/// Coefficients of a grain on the surface of a tire, in the same run.
ContactCoefficients surface_coefficients(const DemOptions& options, const ContactMaterial& material, double step);
/// Stable step of a bed of these grains whose contacts have overlap `overlap`, m.
StableStep stable_at(const DemOptions& options, double overlap);
/// The key that makes the law's contacts proportionally stiffer. At a given force Hertz's overlap depends on its value
/// to the power −2/3.
struct StiffnessKey {
  std::string name, unit;
  double* value = nullptr;  // in the options
};
StiffnessKey stiffness_key(DemOptions& options);
/// The overlap at which scenarios are checked, m.
double stated_overlap(const DemOptions& options);

}  // namespace furrow::terrain::dem
