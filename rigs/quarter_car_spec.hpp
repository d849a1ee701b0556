// The quarter car as an entry of the table of rigs.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/files/read_context.hpp"
#include "rigs/quarter_car_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// Fills in what is open from the tire: rim and body as the block `rim` of its file says, a hundredth of the rim for
/// the rest of what is unsprung, a body at 1.5 Hz with 0.3 of its critical damping, and how it is let down.
/// @throws Error(bad_input) naming the keys where neither of them says a mass
QuarterCarOptions mounted(QuarterCarOptions rig, const MountedTire& tire, const ReadContext& context);

/// @pre the section was checked against the schema
std::unique_ptr<RigSpec> read_quarter_car(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
