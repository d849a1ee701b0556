#include "tire/tire_magnitudes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "protocol/files/nearest_words.hpp"

namespace furrow::tire {
namespace {

struct Range {
  double low, high;
  const char* unit;
};
// Textile cord in rubber is the lightest material of a tire, steel the heaviest and stiffest.
constexpr Range kDensity{100.0, 2e4, "kg/m³"}, kYoungModulus{1e5, 1e12, "Pa"}, kThickness{1e-5, 0.05, "m"};
constexpr double kMaxAngle = 95.0;  // degrees

/// The oddities of a file: the first place of each kind, and the number of further ones.
class Oddities {
 public:
  /// @param kind reported once, such as one quantity of all layers of a section or of all materials
  void add(const std::string& kind, const std::string& key, const std::string& what) {
    for (Oddity& one : found_)
      if (one.kind == kind) return void(++one.more);
    found_.push_back({kind, key, what, 0});
  }
  void look(const std::string& kind, const std::string& key, double value, const Range& range) {
    if (value < range.low || value > range.high)
      add(kind, key,
          fmt::format("is {:g} {}, tires have {:g} to {:g}: another unit?", value, range.unit, range.low, range.high));
  }
  std::vector<std::pair<std::string, std::string>> all() const {
    std::vector<std::pair<std::string, std::string>> texts;
    for (const Oddity& one : found_)
      texts.emplace_back(one.key, one.what + (one.more == 0 ? "" : fmt::format(" (and {} more like it)", one.more)));
    return texts;
  }

 private:
  struct Oddity {
    std::string kind, key, what;
    std::size_t more = 0;
  };
  std::vector<Oddity> found_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> unlikely_values(const TireFile& file) {
  Oddities found;
  for (const LayerMaterial& m : file.materials) {
    found.look("density", "materials." + m.name + ".density", m.density, kDensity);
    for (int i = 0; i < 3; ++i)
      if (i == 0 || m.young_modulus[i] != m.young_modulus[i - 1])
        found.look("young_modulus", "materials." + m.name + ".young_modulus", m.young_modulus[i], kYoungModulus);
  }
  for (const auto& [name, section] :
       {std::pair{"bead", &file.bead}, std::pair{"sidewall", &file.sidewall}, std::pair{"tread", &file.tread}})
    for (std::size_t k = 0; k < section->layers.size(); ++k) {
      const std::string key = fmt::format("sections.{}.layers.{}", name, k);
      found.look(fmt::format("{}.thickness", name), key + ".thickness", section->layers[k].thickness, kThickness);
      if (const double angle = section->layers[k].angle * 180.0 / std::numbers::pi; std::abs(angle) > kMaxAngle)
        found.add(fmt::format("{}.angle", name), key + ".angle_deg",
                  fmt::format("is {:g}°, cords lie within ±90°", angle));
    }
  for (const auto& [key, what] : unusual_values(file)) found.add(key, key, what);
  for (const auto& [key, what] : file.remarks) found.add(key, key, what);
  return found.all();
}

}  // namespace furrow::tire
