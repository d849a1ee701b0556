// A bed that a tire has been over, as the start of another run.
#pragma once

#include "terrain/dem/beds/bed_settling.hpp"

namespace furrow::terrain::dem {

/// Takes the tires away, lets the grains lie for `rest` seconds under the coefficients and step of the run, and then,
/// with the drag of settling, until they are at rest or kMaxSettleTime more have passed. May throw what `progress`
/// throws.
/// @param state what Terrain::save wrote
/// @returns a bed as prepare_bed reads it
/// @throws Error(physics) when a grain is lost, Error(io) when the state is of another kind
/// @pre rest ≥ 0, options.step > 0
Archive bed_after_run(const Archive& state, const DemOptions& options, double rest, const ProgressCall& progress,
                      SettleResult& result);

}  // namespace furrow::terrain::dem
