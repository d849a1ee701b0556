#include "tire/tire_file_chrono.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/files/reader_fields.hpp"
#include "tire/tire_file_reader.hpp"
#include "tire/tire_profile.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

/// Contact properties that the file does not give, from the HMMWV tire file (scripts/docs/tire_models.md).
constexpr double kRubberModulus = 2.47e7;  // Pa
constexpr double kPoissonRatio = 0.45;
constexpr double kRestitution = 0.2;
constexpr double kNormalStiffness = 2.0e6;  // N/m^1.5
constexpr double kNormalDamping = 13.0;     // N s/m^1.5

/// A tire of ReissnerTire; E_z = E_y changes nothing where ν_xz = ν_yz = 0.
void take_plane(JsonReader& reader, LayerMaterial& m) {
  const double across = reader.positive("Ey");
  m.young_modulus = Vec3(reader.positive("Ex"), across, across);
  m.poisson_ratio = Vec3(reader.number("nu"), 0.0, 0.0);
  m.shear_modulus = Vec3(reader.positive("Gxy"), reader.positive("Gxz"), reader.positive("Gyz"));
}

LayerMaterial material(JsonReader reader, int index, bool in_plane) {
  LayerMaterial m;
  m.name = std::to_string(index);
  const std::string type = reader.text("Type");
  m.density = reader.positive("Density");
  if (type == "Isotropic") {
    m.young_modulus = Vec3::Constant(reader.positive("E"));
    const double nu = reader.number("nu");
    m.poisson_ratio = in_plane ? Vec3(nu, 0.0, 0.0) : Vec3::Constant(nu);
    reader.skip("G");
    const double g = reader.has("G") ? reader.positive("G") : 0.5 * m.young_modulus.x() / (1.0 + m.poisson_ratio.x());
    m.shear_modulus = Vec3::Constant(g);
  } else if (type == "Orthotropic" && in_plane) {
    take_plane(reader, m);
  } else if (type == "Orthotropic") {
    const auto e = reader.numbers("E", 3), nu = reader.numbers("nu", 3), g = reader.numbers("G", 3);
    m.young_modulus = Vec3(e[0], e[1], e[2]);
    m.poisson_ratio = Vec3(nu[0], nu[1], nu[2]);
    m.shear_modulus = Vec3(g[0], g[1], g[2]);
  } else {
    reader.fail("Type", fmt::format("is '{}', expected one of: Isotropic, Orthotropic", type));
  }
  if (!(m.young_modulus.minCoeff() > 0.0)) reader.fail("E", "expected numbers above zero");
  if (!(m.shear_modulus.minCoeff() > 0.0)) reader.fail("G", "expected numbers above zero");
  reader.finish();
  return m;
}

Section section(JsonReader reader, std::size_t materials) {
  Section s;
  s.elements_per_side = reader.count("Number Elements", 1, kMaxPerSide);
  const auto thickness = reader.numbers("Layer Thickness");
  const int layers = static_cast<int>(thickness.size());
  if (layers == 0) reader.fail("Layer Thickness", "is empty, expected at least one layer");
  const auto angle = reader.numbers("Ply Angle", layers);
  const auto id = reader.numbers("Material ID", layers);
  for (int l = 0; l < layers; ++l) {
    if (!(thickness[l] > 0.0))
      reader.fail("Layer Thickness", fmt::format("holds {}, expected numbers above zero", thickness[l]));
    if (id[l] < 0 || id[l] >= static_cast<double>(materials) || id[l] != static_cast<int>(id[l]))
      reader.fail("Material ID", fmt::format("holds {}, expected whole numbers from 0 to {}", id[l], materials - 1));
    s.layers.push_back({thickness[l], angle[l] * std::numbers::pi / 180.0, static_cast<int>(id[l])});
  }
  reader.finish();
  return s;
}

}  // namespace

ContactBlock read_chrono_contact(JsonReader reader) {
  ContactBlock c;
  c.friction = reader.not_negative("Coefficient of Friction");
  c.restitution = reader.not_negative_or("Coefficient of Restitution", kRestitution);
  c.young_modulus = kRubberModulus;
  c.poisson_ratio = kPoissonRatio;
  c.normal_stiffness = kNormalStiffness;
  c.normal_damping = kNormalDamping;
  reader.skip("Properties");
  if (reader.has("Properties")) {
    JsonReader p = reader.child("Properties");
    c.young_modulus = p.positive("Young Modulus");
    c.poisson_ratio = p.not_negative("Poisson Ratio");
    p.finish();
  }
  reader.skip("Coefficients");
  if (reader.has("Coefficients")) {
    JsonReader p = reader.child("Coefficients");
    c.normal_stiffness = p.positive("Normal Stiffness");
    c.normal_damping = p.not_negative("Normal Damping");
    p.skip("Tangential Stiffness");
    p.skip("Tangential Damping");
    p.finish();
  }
  reader.finish();
  return c;
}

TireFile read_chrono(JsonReader& reader) {
  TireFile f;
  f.name = reader.text_or("Name", "tire");
  const bool in_plane = reader.text("Template") == "ReissnerTire";
  reader.skip("rim");  // read by tires.cpp for every layout
  if (const auto type = reader.text("Type"); type != "Tire") reader.fail("Type", "is '" + type + "', expected 'Tire'");
  const int parts = !in_plane && reader.flag_or("8-Node Elements", false) ? 2 : 1;  // of an element
  for (const char* key : {"Number Lugs Copies", "Lugs", "Lugs Material"}) reader.skip(key);
  if (reader.has("Lugs")) f.remarks.emplace_back("Lugs", "are left out: the tread is smooth");
  detail::take_value(reader, needed("Tire Radius", "m", keys::kSize, ""), f.radius);
  detail::take_value(reader, needed("Rim Radius", "m", keys::kSize, ""), f.rim_radius);
  detail::take_value(reader, needed("Rim Width", "m", keys::kSize, ""), f.rim_width);
  f.contact = read_chrono_contact(reader.child("Contact Material"));
  const json& materials = reader.array("Materials");
  for (std::size_t m = 0; m < materials.size(); ++m)
    f.materials.push_back(material(JsonReader(materials[m], reader.file(), fmt::format("Materials[{}]", m)),
                                   static_cast<int>(m), in_plane));
  if (f.materials.empty()) reader.fail("Materials", "is empty, expected at least one material");
  f.structural_damping = reader.not_negative("Structural Damping Coefficient");
  f.pressure = reader.not_negative("Default Pressure");
  f.bead = section(reader.child("Bead Section"), f.materials.size());
  f.sidewall = section(reader.child("Sidewall Section"), f.materials.size());
  f.tread = section(reader.child("Tread Section"), f.materials.size());
  f.elements_circumference = parts * reader.count("Number Elements Circumference", 8 / parts, kMaxAround / parts);
  for (Section* part : {&f.bead, &f.sidewall, &f.tread}) part->elements_per_side *= parts;
  f.profile = read_profile(reader, "Profile");
  double top = 0.0;
  for (const ProfileKnot& knot : f.profile) top = std::max(top, f.rim_radius + knot.x);
  if (in_plane && std::abs(top - f.radius) > 1e-3 * f.radius) {  // these count the lugs
    f.remarks.emplace_back("Tire Radius",
                           fmt::format("is {:g} m, but the profile rises to {:g} m, which holds", f.radius, top));
    f.radius = top;
  }
  reader.finish();
  return f;
}

}  // namespace furrow::tire
