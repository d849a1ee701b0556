// Cohesion c of a soil in Mohr–Coulomb's law, as distinct from that of the contacts of its grains.
#pragma once

namespace furrow::terrain {

/// The most that dry sand has, Pa: the sands of [Wong 2008, Table 2.3] have 1.0 to 1.3 kPa, loams more.
inline constexpr double kCohesionOfSand = 2e3;

/// c of grains over their `terrain.cohesion`, roughly: `furrow soil` measures 6.8 ± 1.4 kPa at 80 kPa. The envelope
/// bends, so that c goes with the stresses: grains of 20.8 kPa have 1.35 ± 0.27 kPa under 5 to 25 kPa, 4.4 ± 0.8 kPa
/// under 20 to 100 kPa.
inline constexpr double kBulkCohesionShare = 0.08;

}  // namespace furrow::terrain
