#include "tire/read_tire_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "protocol/core/error.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/tire_file_chrono.hpp"
#include "tire/tire_file_reader.hpp"
#include "tire/tire_profile.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBranches = 100;

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
  section.elements_per_side = reader.count("elements_per_side", 1, kMaxPerSide);
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

TireFile read_own(JsonReader& reader) {
  take_common_keys(reader);
  TireFile f;
  f.name = reader.text_or("name", "tire");
  reader.skip("template");
  read_keys(reader, f);
  if (f.prony.size() > kMaxBranches)
    reader.fail("prony", fmt::format("has {} branches, expected at most {}", f.prony.size(), kMaxBranches));
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

/// A template: the key of its name in the file, the name, and its reader.
struct Template {
  const char* key;
  const char* name;
  TireFile (*read)(JsonReader&);
};
constexpr std::array<Template, 3> kTemplates{{{"template", "ancf_shell", read_own},
                                              {"Template", "ANCFTire", read_chrono},
                                              {"Template", "ReissnerTire", read_chrono}}};

void check(const TireFile& f) {
  double top = 0.0;
  for (const ProfileKnot& knot : f.profile) top = std::max(top, knot.x);
  if (std::abs(f.rim_radius + top - f.radius) > 0.01 * f.radius)
    throw input_error(
        f.path, "profile",
        fmt::format("rises to {:.4f} m above the rim radius of {:.4f} m, expected the tire radius of {:.4f} m", top,
                    f.rim_radius, f.radius));
  for (const LayerMaterial& material : f.materials) stiffness(material, f.path);
}

}  // namespace

TireFile read_tire_file(const std::filesystem::path& file) {
  return read_tire_file(load_json(file, "a tire file in JSON"), file.string());
}

TireFile read_tire_file(const json& document, const std::string& file) {
  JsonReader reader(document, file);
  std::vector<std::string> valid;
  for (const Template& entry : kTemplates) {
    valid.push_back(entry.name);
    if (!reader.has(entry.key)) continue;
    if (reader.text(entry.key) != entry.name) continue;
    TireFile f = entry.read(reader);
    f.path = file;
    check(f);
    return f;
  }
  for (const char* key : {"template", "Template"})
    if (reader.has(key))
      reader.fail(key, fmt::format("is '{}', expected one of: {}", reader.text(key), fmt::join(valid, ", ")));
  reader.fail("template", fmt::format("is missing, expected one of: {}; or 'model' in a tire of another kind",
                                      fmt::join(valid, ", ")));
}

}  // namespace furrow::tire
