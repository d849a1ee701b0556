// The public layouts of Project Chrono's tire files of layered shells (keys "Tire Radius", "Bead Section", …). A tire
// of 8-node elements (ANCFTire with "8-Node Elements") has its nodes, and so 4-node elements of half the size. A
// ReissnerTire states moduli in its plane alone, as its shells bear no stress through the thickness. Ours bear none
// from stretch in the plane where ν_xz = ν_yz = 0, whatever E_z is.
#pragma once

#include "protocol/files/json_reader.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

/// @throws Error(bad_input) naming file and key.
TireFile read_chrono(JsonReader& reader);
/// Its block "Contact Material". @throws Error(bad_input) naming file and key.
ContactBlock read_chrono_contact(JsonReader reader);

}  // namespace furrow::tire
