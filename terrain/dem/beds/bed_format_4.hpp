// Beds written before their state was saved by name: format 4 held accounts, strips and wall contacts as lists of
// numbers in a fixed order. Users keep settled beds, so these are still read.
#pragma once

#include "protocol/core/archive.hpp"

namespace furrow::terrain::dem {

/// The same bed as this version saves it. @throws Error(io) naming what is missing or of another size
Archive from_format_4(const Archive& bed);

}  // namespace furrow::terrain::dem
