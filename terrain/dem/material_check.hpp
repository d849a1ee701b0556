// What a contact law needs of the material of a surface that grains touch.
#pragma once

#include <string>

#include "protocol/core/surface.hpp"

namespace furrow::terrain::dem {

/// @param index of the surface, for the message
/// @throws Error(bad_input) naming the first value with which the law has no force that is finite and resists
void check_material(const ContactMaterial& material, const std::string& law, int index);

}  // namespace furrow::terrain::dem
