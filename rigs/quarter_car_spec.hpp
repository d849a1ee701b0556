// The quarter car as an entry of the table of rigs.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/files/read_context.hpp"
#include "rigs/quarter_car_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// Fills in open values from the tire. The block `rim` of its file gives rim and body. The rest of the unsprung mass is
/// a hundredth of the rim's, and the body gets 1.5 Hz and 0.3 of its critical damping. Also fills in how the wheel is
/// lowered.
/// @throws Error(bad_input) naming the keys if neither scenario nor tire file gives a mass
QuarterCarOptions mounted(QuarterCarOptions rig, const MountedTire& tire, const ReadContext& context);

/// @pre the section was checked against the schema
std::unique_ptr<RigSpec> read_quarter_car(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
