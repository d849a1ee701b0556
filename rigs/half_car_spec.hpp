// The half car as an entry of the table of rigs.
#pragma once

#include <array>
#include <memory>
#include <span>

#include <nlohmann/json_fwd.hpp>

#include "protocol/files/read_context.hpp"
#include "rigs/half_car_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// Fills in open values from the tires, front and rear. The block `rim` of their files gives rim and body (the sum of
/// both carrier masses); both rims are those of the front tire's file. The pitch inertia is m a b, and the rest of the
/// unsprung mass is a hundredth of the rim's. The front of the body gets 1.5 Hz and 0.3 of its critical damping. The
/// rear's stiffness and damping are the front's times the ratio of the weights. Also fills in how the wheels are
/// lowered.
/// @throws Error(bad_input) naming the keys if neither scenario nor tire file gives a mass
HalfCarOptions mounted(HalfCarOptions rig, std::span<const MountedTire, 2> tires, const ReadContext& context);

/// @pre the section was checked against the schema
std::unique_ptr<RigSpec> read_half_car(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
