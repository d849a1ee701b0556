#include "terrain/dem/material_check.hpp"

#include <cmath>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::terrain::dem {

void check_material(const ContactMaterial& material, const std::string& law, int index) {
  const auto require = [&](const char* key, double value, bool fits, const char* expected) {
    if (!fits || !std::isfinite(value))
      throw input_error(fmt::format("surface {}", index), fmt::format("contact.{}", key),
                        fmt::format("is {:g}, expected {} for law '{}'", value, expected, law));
  };
  const ContactMaterial& m = material;
  require("friction", m.friction, m.friction >= 0.0, "0 or more");
  if (law == "hertz_tanh") {
    require("normal_stiffness", m.normal_stiffness, m.normal_stiffness > 0.0, "above 0 N/m^1.5");
    require("normal_damping", m.normal_damping, m.normal_damping >= 0.0, "0 N s/m^1.5 or more");
    return;
  }
  require("young_modulus", m.young_modulus, m.young_modulus > 0.0, "above 0 Pa");
  require("poisson_ratio", m.poisson_ratio, m.poisson_ratio > -1.0 && m.poisson_ratio <= 0.5,
          "above -1 and at most 0.5");
  require("restitution", m.restitution, m.restitution >= 0.0 && m.restitution <= 1.0, "0 to 1");
}

}  // namespace furrow::terrain::dem
