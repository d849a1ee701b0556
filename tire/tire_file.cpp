#include "tire/tire_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::tire {

const char* const kMaterialsShape = R"({"type": "object",
  "additionalProperties": {
    "type": "object", "additionalProperties": false, "required": ["density", "young_modulus", "poisson_ratio"],
    "properties": {
      "density": {"type": "number", "exclusiveMinimum": 0, "unit": "kg/m³", "description": "Density."},
      "young_modulus": {"allOf": [{"$ref": "#/definitions/one_or_three"}], "unit": "Pa",
        "description": "Young's modulus; one number for an isotropic material, or x, y, z."},
      "poisson_ratio": {"allOf": [{"$ref": "#/definitions/one_or_three"}], "unit": "-",
        "description": "Poisson's ratio; one number, or xy, xz, yz with nu_xy / E_x = nu_yx / E_y."},
      "shear_modulus": {"allOf": [{"$ref": "#/definitions/one_or_three"}], "unit": "Pa",
        "description": "Shear modulus; one number, or xy, xz, yz. Default: E / (2 (1 + nu)) of an isotropic material."}
    }}})";

const char* const kSectionsShape = R"({"type": "object", "additionalProperties": false,
  "required": ["bead", "sidewall", "tread"],
  "properties": {"bead": {"$ref": "#/definitions/section"}, "sidewall": {"$ref": "#/definitions/section"},
                 "tread": {"$ref": "#/definitions/section"}}})";

const char* const kProfileShape = R"({"type": "array", "minItems": 4, "maxItems": 2000,
  "items": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}})";

const Section& TireFile::section(int j) const {
  FURROW_ASSERT(in_range(j, elements_width()), j, elements_width());
  const int from_edge = std::min(j, elements_width() - 1 - j);
  if (from_edge < bead.elements_per_side) return bead;
  return from_edge < bead.elements_per_side + sidewall.elements_per_side ? sidewall : tread;
}

// Compliance: S_xx = 1/E_x, S_xy = −ν_xy/E_x, S_xz = −ν_xz/E_x, S_yz = −ν_yz/E_y, shear 1/G [Jones 1999, Eq.
// (2.25)].
Eigen::Matrix<double, 6, 6> stiffness(const LayerMaterial& m, const std::string& file) {
  const Vec3& e = m.young_modulus;
  const Vec3& nu = m.poisson_ratio;
  Mat3 s;
  s << 1.0 / e.x(), -nu.x() / e.x(), -nu.y() / e.x(),  //
      -nu.x() / e.x(), 1.0 / e.y(), -nu.z() / e.y(),   //
      -nu.y() / e.x(), -nu.z() / e.y(), 1.0 / e.z();
  if (s.llt().info() != Eigen::Success)
    throw input_error(file, "materials." + m.name + ".poisson_ratio",
                      "gives a material that is not stable (negative strain energy), expected smaller ratios");
  const Mat3 c = s.inverse();
  Eigen::Matrix<double, 6, 6> full = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr std::array<int, 3> kNormal{0, 1, 3};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) full(kNormal[a], kNormal[b]) = c(a, b);
  full(2, 2) = m.shear_modulus.x();
  full(4, 4) = m.shear_modulus.y();
  full(5, 5) = m.shear_modulus.z();
  return full;
}

void set_elements_width(TireFile& f, int elements) {
  if (elements < 6 || elements % 2 != 0)
    throw input_error(f.path, "elements_width", fmt::format("is {}, expected an even number of at least 6", elements));
  const int side = elements / 2;
  const double scale = 2.0 * side / f.elements_width();
  const auto share = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  const int bead = share(f.bead.elements_per_side);
  int sidewall = share(f.sidewall.elements_per_side);
  if (bead + sidewall >= side) sidewall = side - bead - 1;
  if (sidewall < 1)
    throw input_error(f.path, "elements_width", fmt::format("is {}, too few for the tire's three sections", elements));
  f.bead.elements_per_side = bead;
  f.sidewall.elements_per_side = sidewall;
  f.tread.elements_per_side = side - bead - sidewall;
}

}  // namespace furrow::tire
