// The vehicle rig as an entry of the table of rigs.
#pragma once

#include <memory>
#include <vector>

#include "protocol/files/read_context.hpp"
#include "rigs/rig_spec.hpp"
#include "rigs/vehicle/vehicle_options.hpp"
#include "rigs/wheel_tire.hpp"

namespace furrow::rigs {

/// @throws Error(bad_input) naming file and key: of the scenario, the vehicle's file or the driver's file
std::unique_ptr<RigSpec> read_vehicle_rig(const nlohmann::json& section, const ReadContext& context);

/// The tires that the wheels of the vehicle name.
/// @throws Error(bad_input) naming file and key
std::vector<WheelTire> tires_of_vehicle(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
