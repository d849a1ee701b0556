// A bed over which a tire has rolled, as the start of another run.
#pragma once

#include "terrain/dem/beds/bed_settling.hpp"

namespace furrow::terrain::dem {

/// Removes the tires and lets the grains lie for `rest` seconds with the coefficients and step of the run. Then they
/// settle with the drag of settling until they are at rest or kMaxSettleTime more has passed. May throw what `progress`
/// throws.
/// @param state saved by Terrain::save
/// @returns a bed in the form that prepare_bed reads
/// @throws Error(physics) when a grain is lost, Error(io) when the state is of another kind
/// @pre rest ≥ 0, options.step > 0
Archive bed_after_run(const Archive& state, const DemOptions& options, double rest, const ProgressCall& progress,
                      SettleResult& result);

}  // namespace furrow::terrain::dem
