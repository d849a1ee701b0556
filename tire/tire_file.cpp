#include "tire/tire_file.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "protocol/error.hpp"
#include "tire/json_reader.hpp"
#include "tire/tire_file_chrono.hpp"

namespace furrow {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;

/// A number for an isotropic material, three for an orthotropic one.
Vec3 one_or_three(JsonReader& reader, const std::string& key) {
  if (reader.has(key) && reader.object().at(key).is_number()) return Vec3::Constant(reader.number(key));
  const auto v = reader.numbers(key, 3);
  return Vec3(v[0], v[1], v[2]);
}

LayerMaterial read_material(JsonReader reader, const std::string& name) {
  LayerMaterial m;
  m.name = name;
  m.density = reader.positive("density");
  m.young_modulus = one_or_three(reader, "young_modulus");
  m.poisson_ratio = one_or_three(reader, "poisson_ratio");
  reader.skip("shear_modulus");
  const bool isotropic = reader.object().at("young_modulus").is_number();
  if (isotropic && !reader.has("shear_modulus"))
    m.shear_modulus = Vec3::Constant(0.5 * m.young_modulus.x() / (1.0 + m.poisson_ratio.x()));
  else
    m.shear_modulus = one_or_three(reader, "shear_modulus");
  if (!(m.young_modulus.minCoeff() > 0.0)) reader.fail("young_modulus", "expected numbers above zero");
  if (!(m.shear_modulus.minCoeff() > 0.0)) reader.fail("shear_modulus", "expected numbers above zero");
  reader.finish();
  return m;
}

Section read_section(JsonReader reader, const std::vector<LayerMaterial>& materials) {
  Section section;
  section.elements_per_side = reader.count("elements_per_side", 1);
  const json& layers = reader.array("layers");
  if (layers.empty()) reader.fail("layers", "is empty, expected at least one layer");
  for (std::size_t i = 0; i < layers.size(); ++i) {
    JsonReader entry(layers[i], reader.file(), reader.full(fmt::format("layers[{}]", i)));
    Layer layer;
    layer.thickness = entry.positive("thickness");
    layer.angle = entry.number("angle_deg") * std::numbers::pi / 180.0;
    const std::string name = entry.text("material");
    std::vector<std::string> names;
    layer.material = -1;
    for (std::size_t m = 0; m < materials.size(); ++m) {
      names.push_back(materials[m].name);
      if (materials[m].name == name) layer.material = static_cast<int>(m);
    }
    if (layer.material < 0)
      entry.fail("material", fmt::format("is '{}', expected one of: {}", name, fmt::join(names, ", ")));
    entry.finish();
    section.layers.push_back(layer);
  }
  reader.finish();
  return section;
}

ContactMaterial read_contact(JsonReader reader) {
  ContactMaterial c;
  c.young_modulus = reader.positive("young_modulus");
  c.poisson_ratio = reader.not_negative("poisson_ratio");
  c.friction = reader.not_negative("friction");
  c.restitution = reader.not_negative("restitution");
  c.normal_stiffness = reader.positive("normal_stiffness");
  c.normal_damping = reader.not_negative("normal_damping");
  if (c.poisson_ratio >= 0.5)
    reader.fail("poisson_ratio", fmt::format("is {}, expected 0 to below 0.5", c.poisson_ratio));
  if (c.restitution > 1.0) reader.fail("restitution", fmt::format("is {}, expected 0 to 1", c.restitution));
  reader.finish();
  return c;
}

std::vector<MaxwellBranch> read_prony(JsonReader& reader) {
  std::vector<MaxwellBranch> branches;
  if (!reader.has("prony")) return branches;
  const json& rows = reader.array("prony");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    JsonReader row(rows[i], reader.file(), reader.full(fmt::format("prony[{}]", i)));
    branches.push_back({row.positive("relative_modulus"), row.positive("relaxation_time")});
    row.finish();
  }
  return branches;
}

TireFile read_own(JsonReader& reader) {
  const int version = reader.count("format_version", 1);
  if (version > kFormatVersion)
    reader.fail("format_version", fmt::format("is {}, this program reads up to {}", version, kFormatVersion));
  TireFile f;
  f.name = reader.text_or("name", "tire");
  reader.skip("template");
  reader.skip("source");
  reader.skip("$schema");
  f.radius = reader.positive("radius");
  f.rim_radius = reader.positive("rim_radius");
  f.rim_width = reader.positive("rim_width");
  f.pressure = reader.not_negative("pressure");
  f.structural_damping = reader.not_negative("structural_damping");
  f.prony = read_prony(reader);
  f.tread_mass_per_area = reader.not_negative_or("tread_mass_per_area", 0.0);
  f.elements_circumference = reader.count("elements_circumference", 8);
  f.contact = read_contact(reader.child("contact"));
  JsonReader materials = reader.child("materials");
  for (const auto& [name, value] : materials.object().items())
    f.materials.push_back(read_material(materials.child(name), name));
  JsonReader sections = reader.child("sections");
  f.bead = read_section(sections.child("bead"), f.materials);
  f.sidewall = read_section(sections.child("sidewall"), f.materials);
  f.tread = read_section(sections.child("tread"), f.materials);
  sections.finish();
  f.profile = read_profile(reader, "profile");
  reader.finish();
  return f;
}

/// Where a template's name stands in the file, its name, and what reads it.
struct Template {
  const char* key;
  const char* name;
  TireFile (*read)(JsonReader&);
};
constexpr std::array<Template, 2> kTemplates{
    {{"template", "ancf_shell", read_own}, {"Template", "ANCFTire", read_chrono}}};

void check(const TireFile& f) {
  double top = 0.0;
  for (const ProfileKnot& knot : f.profile) top = std::max(top, knot.x);
  if (std::abs(f.rim_radius + top - f.radius) > 0.01 * f.radius)
    throw input_error(
        f.path, "profile",
        fmt::format(
            "rises to {:.4f} m above the rim radius of {:.4f} m, expected the tire radius of {:.4f} m", top,
            f.rim_radius, f.radius));
  for (const LayerMaterial& material : f.materials) stiffness(material, f.path);
}

}  // namespace

const Section& TireFile::section(int j) const {
  const int from_edge = std::min(j, elements_width() - 1 - j);
  if (from_edge < bead.elements_per_side) return bead;
  return from_edge < bead.elements_per_side + sidewall.elements_per_side ? sidewall : tread;
}

std::vector<ProfileKnot> read_profile(JsonReader& reader, const std::string& key) {
  std::vector<ProfileKnot> profile;
  for (const json& row : reader.array(key)) {
    const std::size_t k = profile.size();
    const bool three =
        row.is_array() && row.size() == 3 && row[0].is_number() && row[1].is_number() && row[2].is_number();
    if (!three) reader.fail(fmt::format("{}[{}]", key, k), "expected three numbers t, x, y");
    profile.push_back({row[0].get<double>(), row[1].get<double>(), row[2].get<double>()});
    if (profile[k].x < -1e-9)
      reader.fail(fmt::format("{}[{}]", key, k), "lies below the rim radius, expected x of zero or above");
    if (k > 0 && !(profile[k].t > profile[k - 1].t))
      reader.fail(fmt::format("{}[{}]", key, k), "expected t to increase");
  }
  if (profile.size() < 4) reader.fail(key, fmt::format("has {} knots, expected at least 4", profile.size()));
  if (std::abs(profile.front().t) > 1e-9 || std::abs(profile.back().t - 1.0) > 1e-9)
    reader.fail(key,
                fmt::format("runs from t = {} to {}, expected 0 to 1", profile.front().t, profile.back().t));
  if (!(profile.back().y > profile.front().y))
    reader.fail(key, "expected y to run from the left (negative) to the right bead");
  return profile;
}

TireFile read_tire_file(const std::filesystem::path& file) {
  const json document = load_json(file);
  JsonReader reader(document, file.string());
  std::vector<std::string> valid;
  for (const Template& entry : kTemplates) {
    valid.push_back(entry.name);
    if (!reader.has(entry.key)) continue;
    if (reader.text(entry.key) != entry.name) continue;
    TireFile f = entry.read(reader);
    f.path = file.string();
    check(f);
    return f;
  }
  for (const char* key : {"template", "Template"})
    if (reader.has(key))
      reader.fail(key, fmt::format("is '{}', expected one of: {}", reader.text(key), fmt::join(valid, ", ")));
  reader.fail("template", fmt::format("is missing, expected one of: {}", fmt::join(valid, ", ")));
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
    throw input_error(
        file, "materials." + m.name + ".poisson_ratio",
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
    throw input_error(f.path, "elements_width",
                      fmt::format("is {}, expected an even number of at least 6", elements));
  const int side = elements / 2;
  const double scale = 2.0 * side / f.elements_width();
  const auto share = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  const int bead = share(f.bead.elements_per_side);
  int sidewall = share(f.sidewall.elements_per_side);
  if (bead + sidewall >= side) sidewall = side - bead - 1;
  if (sidewall < 1)
    throw input_error(f.path, "elements_width",
                      fmt::format("is {}, too few for the tire's three sections", elements));
  f.bead.elements_per_side = bead;
  f.sidewall.elements_per_side = sidewall;
  f.tread.elements_per_side = side - bead - sidewall;
}

}  // namespace furrow
