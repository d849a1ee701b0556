// A bed that a tire has been over, as the start of another run.
#pragma once

#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

struct RestResult {
  bool settled = false;      // by force ratio and speed, as a new bed
  double time = 0.0;         // simulated in all, s
  double force_ratio = 0.0;  // Σ|net force| / Σ|contact force| at the end
  double floor_error = 0.0;  // |floor force − weight| / weight; walls may carry a share
  double speed = 0.0;        // rms of the grains, m/s
};

/// Takes the tires away, lets the grains lie for `rest` seconds under the coefficients and step of the run, and then,
/// with the drag of settling, until they are at rest or kMaxSettleTime more have passed. May throw what `progress`
/// throws.
/// @param state what Terrain::save wrote
/// @returns a bed as prepare_bed reads it
/// @throws Error(physics) when a grain is lost, Error(io) when the state is of another kind
/// @pre rest ≥ 0, options.step > 0
Archive bed_after_run(const Archive& state, const DemOptions& options, double rest, const ProgressCall& progress,
                      RestResult& result);

}  // namespace furrow::terrain::dem
