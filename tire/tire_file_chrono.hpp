// The public ANCFTire layout of Project Chrono's tire files (keys "Tire Radius", "Bead Section", …).
#pragma once

#include "protocol/files/json_reader.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

/// @throws Error(bad_input) naming file and key.
TireFile read_chrono(JsonReader& reader);

}  // namespace furrow::tire
