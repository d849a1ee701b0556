// Straight grousers of a rigid wheel: plates that stand across its tread, evenly spaced, from one side to the other.
#pragma once

#include "tire/tire.hpp"

namespace furrow::tire {

inline constexpr int kGrouserCells = 4;                           // of a plate, across the tread
inline constexpr int kGrouserVertices = 4 * (kGrouserCells + 1);  // of a plate

/// Adds the plates to the surface of an undeformed wheel; its last two vertices stay the last. Each plate begins inside
/// the tread, as deep as it is high beyond it, and follows the tread's profile, at each of its vertices that of the
/// wheel's vertex nearest across. Mass and radius stay those of the wheel.
/// @param height beyond the tread, m @param thickness along the circumference, m
/// @pre number ≥ 1; height, thickness > 0; number × thickness < 2π × radius; height < radius
void add_grousers(TireShape& shape, int number, double height, double thickness);

}  // namespace furrow::tire
