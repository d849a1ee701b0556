#include "tire/tire_magnitudes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace furrow::tire {
namespace {

struct Range {
  double low, high;
  const char* unit;
};
// Textile cord in rubber is the lightest material of a tire, steel the heaviest and stiffest.
constexpr Range kDensity{100.0, 2e4, "kg/m³"}, kYoungModulus{1e5, 1e12, "Pa"}, kThickness{1e-5, 0.05, "m"},
    kPressure{1e3, 2e6, "Pa"}, kRimWidth{0.05, 1.5, "m"}, kRadius{0.02, 3.0, "m"};
constexpr double kMaxAngle = 95.0;       // degrees
constexpr double kMaxTreadMass = 100.0;  // kg/m²: 8 cm of rubber

}  // namespace

std::vector<std::pair<std::string, std::string>> unlikely_values(const TireFile& file) {
  std::vector<std::pair<std::string, std::string>> found;
  const auto look = [&](const std::string& key, double value, const Range& range) {
    if (value < range.low || value > range.high)
      found.emplace_back(key, fmt::format("is {:g} {}, tires have {:g} to {:g}: another unit?", value,
                                          range.unit, range.low, range.high));
  };
  for (const LayerMaterial& m : file.materials) {
    look("materials." + m.name + ".density", m.density, kDensity);
    for (int i = 0; i < 3; ++i)
      if (i == 0 || m.young_modulus[i] != m.young_modulus[i - 1])
        look("materials." + m.name + ".young_modulus", m.young_modulus[i], kYoungModulus);
  }
  for (const auto& [name, section] : {std::pair{"bead", &file.bead}, std::pair{"sidewall", &file.sidewall},
                                      std::pair{"tread", &file.tread}})
    for (std::size_t k = 0; k < section->layers.size(); ++k) {
      const std::string key = fmt::format("sections.{}.layers.{}", name, k);
      look(key + ".thickness", section->layers[k].thickness, kThickness);
      if (const double angle = section->layers[k].angle * 180.0 / std::numbers::pi;
          std::abs(angle) > kMaxAngle)
        found.emplace_back(key + ".angle_deg", fmt::format("is {:g}°, cords lie within ±90°", angle));
    }
  look("radius", file.radius, kRadius);
  look("rim_radius", file.rim_radius, kRadius);
  look("rim_width", file.rim_width, kRimWidth);
  if (file.pressure != 0.0) look("pressure", file.pressure, kPressure);
  if (file.tread_mass_per_area > kMaxTreadMass)
    found.emplace_back("tread_mass_per_area",
                       fmt::format("is {:g} kg/m², tires have up to {:g}: another unit?",
                                   file.tread_mass_per_area, kMaxTreadMass));
  return found;
}

}  // namespace furrow::tire
