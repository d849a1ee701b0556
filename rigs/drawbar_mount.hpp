// What the drawbar rig takes from its tire where the scenario leaves it open.
//
// Masses. load = (carrier + rim + tire) g. Given the load, the carrier's mass follows; given neither, the tire file's
// block `rim` says it. There is no other default: a mass that suits one wheel is wrong for the next.
//
// Touch-down. A damper c between the rail and a wheel of weight W lets it down at v = W/c, slower as the ground takes
// over: m z̈ = W − F(z) − c ż. Wheels that are alike in shape behave alike at equal Froude number v/√(g R) [Freitag
// 1965], so v = 0.18 √(g R) for a time of 1.6 √(R/g): what was tried on the wheel of the reference rig (0.39 m/s and
// 0.35 s at R = 0.467 m, 4.6 kN, 12 kN s/m), about half of the critical damping of its bounce.
//
// [Freitag 1965] A dimensional analysis of the performance of pneumatic tires on soft soils. US Army Engineer Waterways
//   Experiment Station, Technical Report 3-688.
#pragma once

#include <string>

#include "protocol/files/read_context.hpp"
#include "rigs/drawbar_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// The options with everything given.
/// @param wheel what stands before the names of the wheel's own keys: "", "wheels.1."
/// @throws Error(bad_input) when neither scenario nor tire file say a mass, or the load is too small for the masses
DrawbarRigOptions mounted(DrawbarRigOptions rig, const MountedTire& tire, const ReadContext& context,
                          const std::string& wheel);

}  // namespace furrow::rigs
