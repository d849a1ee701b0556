// furrow_faults has one terrain more than furrow: the mat of several ranks. This file replaces
// terrain/extra_terrains.cpp.
#include "terrain/extra_terrains.hpp"

#include <array>

#include "protocol/files/json_fields.hpp"
#include "tests/dummies/strip_mat.hpp"

namespace furrow::terrain {

std::span<const TerrainEntry> extra_terrains() {
  static constexpr std::array kExtra{
      TerrainEntry{"strip_mat", "a mat of springs on several ranks", key_list<StripMatOptions>(), read_strip_mat},
  };
  return kExtra;
}

}  // namespace furrow::terrain
