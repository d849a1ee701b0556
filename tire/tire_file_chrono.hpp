// The public ANCFTire layout of Project Chrono's tire files (keys "Tire Radius", "Bead Section", …).
#pragma once

#include "tire/json_reader.hpp"
#include "tire/tire_file.hpp"

namespace furrow {

/// @throws Error(bad_input) naming file and key.
TireFile read_chrono(JsonReader& reader);

/// Rows t, x, y (both layouts share them).
std::vector<ProfileKnot> read_profile(JsonReader& reader, const std::string& key);

}  // namespace furrow
