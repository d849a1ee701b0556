// Values that the drawbar rig takes from its tire if the scenario leaves them open.
//
// Masses. load = (carrier + rim + tire) g. If the load is given, the carrier's mass follows from it. If neither is
// given, the block `rim` of the tire file sets the mass. There is no other default: a mass that suits one wheel is
// wrong for the next.
//
// Touch-down. A damper c between the rail and a wheel of weight W lowers it at v = W/c, slower as the ground takes
// over: m z̈ = W − F(z) − c ż. Wheels of similar shape behave alike at equal Froude number v/√(g R) [Freitag 1965].
// Therefore v = 0.18 √(g R) for a time of 1.6 √(R/g), from a trial on the reference rig's wheel: 0.39 m/s and 0.35 s at
// R = 0.467 m, 4.6 kN, 12 kN s/m. This is about half of the critical damping of its bounce.
//
// [Freitag 1965] A dimensional analysis of the performance of pneumatic tires on soft soils. US Army Engineer Waterways
//   Experiment Station, Technical Report 3-688.
#pragma once

#include <string>

#include "protocol/files/read_context.hpp"
#include "rigs/drawbar_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// Returns the options with every open value filled in.
/// @param wheel prefix of the wheel's own keys: "", "wheels.1."
/// @throws Error(bad_input) if neither scenario nor tire file gives a mass, or the load is too small for the masses
DrawbarRigOptions mounted(DrawbarRigOptions rig, const MountedTire& tire, const ReadContext& context,
                          const std::string& wheel);

}  // namespace furrow::rigs
