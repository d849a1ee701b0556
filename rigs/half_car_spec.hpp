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

/// Fills in what is open from the tires, front and rear: rim and body (the carrier masses of both) as the block `rim`
/// of their files says, a pitch inertia m a b, a hundredth of the rim for the rest of what is unsprung, the front of
/// the body at 1.5 Hz with 0.3 of its critical damping, the rear likewise stiff and damped for the weight that it
/// bears, and how the wheels are let down. Both rims are as the file of the front tire says.
/// @throws Error(bad_input) naming the keys where neither of them says a mass
HalfCarOptions mounted(HalfCarOptions rig, std::span<const MountedTire, 2> tires, const ReadContext& context);

/// @pre the section was checked against the schema
std::unique_ptr<RigSpec> read_half_car(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
