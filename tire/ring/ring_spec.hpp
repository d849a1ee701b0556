// The flexible-ring tire as an entry of the table of models: its file, a scenario's changes of it, its description.
#pragma once

#include <array>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/key.hpp"
#include "tire/ring/ring_params.hpp"
#include "tire/tire_file_keys.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

struct RingFile {
  static constexpr SchemaName kSchema{"ring",
                                      "A fast model: an inflated belt of segments on a nonlinear sidewall, seen from "
                                      "the side and alike across its width. "
                                      "SI units; per radian means per radian of the belt."};
  std::string path;
  RingParams params;
  RingMotion motion{.damping = 5e-3};
  std::array<double, 3> sidewall{};  // k₁, k₂, k₃ of the parameters
  double diametral_inertia = 0.0;    // kg m²
  ContactBlock contact;
};
void visit_fields(FieldsOf<RingFile> auto& s, auto&& visit) {
  using namespace allowed;
  auto& p = s.params;
  auto& m = s.motion;
  visit(
      p.segments,
      needed("segments", "", from(kMinSegments, kMaxSegments),
             "Segments of the belt; tire.elements_circumference overrides it. The other numbers mean the same for any "
             "number of them."));
  visit(p.radius, needed("radius", "m", keys::kSize, "Radius R of the inflated belt; the same at every pressure."));
  visit(p.width, needed("width", "m", keys::kSize, "Width T of the belt."));
  visit(m.rim_radius, needed("rim_radius", "m", keys::kSize, "Radius of the rim, which the belt must not reach."));
  visit(p.pressure, keys::kPressure);
  visit(p.air_share, needed("air_share", "-", above(0).to(1), "Volume of air / (pi R² T)."));
  visit(p.bending, needed("bending", "N/m", above(0), "Bending stiffness A of the belt per radian: E I / R³."));
  visit(p.shear, needed("shear", "N/m", above(0).usual(1e3, 1e10),
                        "Stiffness B of the belt against gradients of its hoop strain, per radian."));
  visit(
      s.sidewall,
      needed(
          "sidewall", "",
          shaped(R"({"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number", "minimum": 0}})"),
          "Stiffnesses k1 (N/m), k2 (N/m²), k3 (N/m³) of the sidewall per radian: it pulls with k1 w + k2 w² + k3 w³, "
          "w its extension; k1 above 0, k2² at most 3 k1 k3."));
  visit(
      p.tangential,
      needed("tangential", "N/m", above(0).usual(1e3, 1e9),
             "Stiffness k_t of the sidewall against tangential displacement, per radian; the torsional stiffness is 2 "
             "pi R² k_t."));
  visit(p.tension_share,
        key("tension_share", "-", from(0, 1),
            "Share of the pressure that the belt holds as a membrane, by a hoop tension of tension_share × pressure × "
            "radius × width; the sidewall holds the rest. 0: no hoop tension."));
  visit(m.damping,
        key("structural_damping", "s", keys::kDampingTime,
            "Kelvin-Voigt time tau of belt and sidewall: tau × tangent × rate is added to their forces in motion; "
            "tire.structural_damping overrides it."));
  visit(p.gas, key("gas", "", words("linearised exact"),
                   "Law of the air: pressure times volume is constant, or the tangent of that law."));
  visit(p.kinematics,
        key("kinematics", "", words("radial exact"),
            "exact: segments touch the ground at their displaced positions. radial: each touches it at its undeformed "
            "angle."));
  visit(
      m.mass,
      needed("mass", "kg", above(0).usual(0.01, 2000),
             "Mass of the tire; in motion a belt at its radius and a rest at rim_radius share it so that spin_inertia "
             "comes out."));
  visit(m.spin_inertia,
        needed("spin_inertia", "kg m²", above(0),
               "Moment of inertia of the tire about its axle; between mass × rim_radius² and mass × radius²."));
  visit(s.diametral_inertia,
        needed("diametral_inertia", "kg m²", above(0), "Moment of inertia of the tire about a diameter."));
  visit(s.contact, keys::kContact);
}

/// @throws Error(bad_input) naming file and key
RingFile read_ring_file(const nlohmann::json& file, const std::string& path);

/// @throws Error(bad_input) naming file and key
std::unique_ptr<TireSpec> read_ring(const nlohmann::json& file, const TireOptions& options);

}  // namespace furrow::tire
