// Cohesion c of a soil in Mohr–Coulomb's law, as distinct from the cohesion at the contacts of its grains.
#pragma once

namespace furrow::terrain {

/// Largest cohesion of dry sand, Pa: the sands of [Wong 2008, Table 2.3] have 1.0 to 1.3 kPa, loams more.
inline constexpr double kCohesionOfSand = 2e3;

/// Rough ratio of c to the grains' `terrain.cohesion`: `furrow soil` measures 6.8 ± 1.4 kPa at 80 kPa. The envelope
/// bends, so c depends on the stresses: grains of 20.8 kPa have 1.35 ± 0.27 kPa under 5 to 25 kPa, and 4.4 ± 0.8 kPa
/// under 20 to 100 kPa.
inline constexpr double kBulkCohesionShare = 0.08;

}  // namespace furrow::terrain
