#include "tire/handling/handling_spec.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/cylinder.hpp"
#include "tire/handling/handling_press.hpp"
#include "tire/handling/handling_tire.hpp"
#include "tire/handling/magic_formula.hpp"
#include "tire/handling/tir_file.hpp"
#include "tire/tire_file_reader.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

constexpr int kFacets = 96, kRows = 7;                      // of the surface
constexpr double kLeastNominal = 0.01, kMostNominal = 0.3;  // deflection under FNOMIN, of the radius
constexpr double kMostFactor = 5.0;
constexpr double kLeastPeak = 0.05, kMostPeak = 5.0;  // grip under FNOMIN
constexpr double kTreadFriction = 0.9;                // of ContactMaterial, which only rigid tires use

/// @throws Error(bad_input)
void require_inertia(const HandlingFile& file) {
  if (!file.lacking.empty()) throw input_error(file.path, file.lacking_key, file.lacking);
}

/// Whether a coefficient of the inflation pressure is not 0.
bool feels_pressure(const handling::MagicFormula& t) {
  bool feels = false;
  handling::visit_coefficients(t, [&](double value, const Field& field) {
    const std::string_view name = field.name;
    feels |= value != 0.0 && (name.starts_with("PP") || name == "PFZ1" || name == "QSY8");
  });
  return feels;
}

class HandlingSpec final : public TireSpec {
 public:
  HandlingSpec(HandlingFile file, const TireOptions& options) : TireSpec(options), file_(std::move(file)) {}

  TireDescription describe() const override;
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    require_inertia(file_);
    return std::make_unique<handling::HandlingTire>(
        context.ground_friction ? handling::on_ground_of(file_.formula, *context.ground_friction) : file_.formula,
        shape(), context.gravity, file_.tir.string(), context.ground_heights);
  }
  TireShape shape() const override;
  std::unique_ptr<StaticTest> static_test() const override {
    return static_test_of([formula = file_.formula, mass = mass()](const auto& options, const ProgressCall&) {
      return handling::press_handling(formula, mass, options);
    });
  }
  std::vector<std::filesystem::path> files() const override {
    return is_tir(options().file) ? std::vector<std::filesystem::path>{} : std::vector{file_.tir};
  }
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override;

 private:
  MassProperties mass() const {
    return {file_.mass, Vec3(file_.diametral_inertia, file_.spin_inertia, file_.diametral_inertia).asDiagonal()};
  }

  HandlingFile file_;
};

TireDescription HandlingSpec::describe() const {
  const handling::MagicFormula& t = file_.formula;
  const handling::RelaxationLengths s = handling::relaxation_lengths(t, t.vertical.fnomin, 0.0);
  TireDescription d;
  d.kind = "handling";
  d.name = "handling (Magic Formula)";
  d.details =
      fmt::format("{}, {:g} N, {:g} kN/m, relaxation {:.3g} m along, {:.3g} m across", file_.tir.filename().string(),
                  t.vertical.fnomin, 1e-3 * spring_stiffness(t, t.vertical.fnomin), s.longitudinal, s.lateral);
  d.radius = t.dimension.unloaded_radius;
  d.width = d.tread_width = t.dimension.width;
  if (t.dimension.rim_radius > 0.0) d.section_height = d.radius - t.dimension.rim_radius;
  d.coordinates = 2;
  d.vertices = kFacets * kRows + 2;
  d.facets = kFacets;
  d.mass = mass();
  d.memory = 1e6;
  d.saved_bytes = 1e4;
  d.follows_rim = true;
  if (t.conditions.nompres > 0.0 && feels_pressure(t)) d.takes = {"pressure"};
  const double slip_stiffness = std::abs(handling::evaluate(t, {.load = t.vertical.fnomin}).slip_stiffness);
  d.vertical_stiffness = handling::spring_stiffness(t, t.vertical.fnomin);
  d.contact_length = handling::contact_length(t);
  d.most_load = t.load.most;
  if (s.longitudinal > 0.0)
    d.grip_stiffness = slip_stiffness / s.longitudinal;
  else
    d.grip_damping = slip_stiffness / t.low_speed;
  if (!file_.lacking.empty())
    d.static_only = fmt::format("whose key '{}' in {} {}", file_.lacking_key, file_.path, file_.lacking);
  d.own_contact = "its forces are those of the Magic Formula, which holds for hard ground";
  return d;
}

TireShape HandlingSpec::shape() const {
  const handling::Dimensions& size = file_.formula.dimension;
  TireShape shape = cylinder(kFacets, size.unloaded_radius, size.width, kRows);
  // For tire.rigid alone, on any ground: rubber.
  shape.material = {.young_modulus = 2.47e7,
                    .poisson_ratio = 0.45,
                    .friction = kTreadFriction,
                    .restitution = 0.2,
                    .normal_stiffness = 2e6,
                    .normal_damping = 13.0};
  options().apply_to(shape.material);
  shape.mass = mass();
  return shape;
}

std::vector<std::pair<std::string, std::string>> HandlingSpec::unlikely_values() const {
  auto odd = unusual_values(file_);
  const handling::MagicFormula& t = file_.formula;
  const std::string at = file_.tir.filename().string();
  if (t.aligning.qtz1 != 0.0 && t.aligning.mbelt != 0.0)
    odd.emplace_back("[ALIGNING_COEFFICIENTS] QTZ1",
                     "of " + at + " is not used: the gyroscopic moment of the belt is left out");
  for (const auto& [key, what] : t.remarks) odd.emplace_back(key, "of " + at + " " + what);
  const double nominal = handling::spring_deflection(t, t.vertical.fnomin) / t.dimension.unloaded_radius;
  if (nominal < kLeastNominal || nominal > kMostNominal)
    odd.emplace_back("[VERTICAL] FNOMIN",
                     fmt::format("of {}, {:g} N, deflects the tire by {:.2g} % of its radius, usual are 2 to 15 %: "
                                 "expected FNOMIN in N and VERTICAL_STIFFNESS in N/m",
                                 at, t.vertical.fnomin, 100.0 * nominal));
  if (t.vertical.fnomin < t.load.least || t.vertical.fnomin > t.load.most)
    odd.emplace_back("[VERTICAL_FORCE_RANGE] FZMIN, FZMAX",
                     fmt::format("of {} are {:g} and {:g} N and leave out FNOMIN of {:g} N: expected all in N", at,
                                 t.load.least, t.load.most, t.vertical.fnomin));
  visit_fields(t.scaling, [&](double value, const Field& field) {
    if (std::abs(value) > kMostFactor)
      odd.emplace_back(std::string("[SCALING_COEFFICIENTS] ") + field.name,
                       fmt::format("of {} is {:g}, usual are 0 to 2: it is a factor, not per cent", at, value));
  });
  for (const auto& [key, peak] : {std::pair{"[LONGITUDINAL_COEFFICIENTS] PDX1", t.longitudinal.pdx1 * t.scaling.lmux},
                                  {"[LATERAL_COEFFICIENTS] PDY1", t.lateral.pdy1 * t.scaling.lmuy}})
    if (std::abs(peak) < kLeastPeak || std::abs(peak) > kMostPeak)
      odd.emplace_back(key, fmt::format("of {} makes a grip of {:g} under FNOMIN, usual are 0.3 to 3", at, peak));
  if (const auto s = handling::relaxation_lengths(t, t.vertical.fnomin, 0.0); s.longitudinal == 0.0 || s.lateral == 0.0)
    odd.emplace_back(s.longitudinal == 0.0 ? "[LONGITUDINAL_COEFFICIENTS] PTX1" : "[LATERAL_COEFFICIENTS] PTY1, PTY2",
                     "of " + at + ": missing or 0: without a relaxation length a standing wheel creeps under a force");
  const bool along = handling::ellipse_along(t), across = handling::ellipse_across(t);
  if (!t.friction_ellipse && (along || across))
    odd.emplace_back(along && across ? "[LONGITUDINAL_COEFFICIENTS] RBX1, [LATERAL_COEFFICIENTS] RBY1"
                     : along         ? "[LONGITUDINAL_COEFFICIENTS] RBX1"
                                     : "[LATERAL_COEFFICIENTS] RBY1",
                     "of " + at + ": missing or 0: a friction ellipse is used for combined slip");
  if (t.dimension.unloaded_radius < 0.05 || t.dimension.unloaded_radius > 2.0)
    odd.emplace_back("[DIMENSION] UNLOADED_RADIUS",
                     fmt::format("of {} is {:g} m, usual are 0.1 to 1 m", at, t.dimension.unloaded_radius));
  return odd;
}

}  // namespace

bool is_tir(const std::filesystem::path& file) {
  std::string end = file.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return end == ".tir";
}

json tire_file_of_tir(const std::filesystem::path& file) {
  return {{"format_version", 1}, {"model", "handling"}, {"tir", file.string()}};
}

HandlingFile read_handling_file(const json& document, const std::string& path) {
  JsonReader reader(document, path);
  take_common_keys(reader);
  HandlingFile f;
  f.path = path;
  read_keys(reader, f);
  if (!f.tir.is_absolute()) f.tir = std::filesystem::path(path).parent_path() / f.tir;
  if (is_tir(path)) f.tir = path;
  f.formula = handling::read_tir(f.tir);
  const handling::TireInertia& said = f.formula.inertia;
  const auto fill = [&](double& value, const char* key, double in_tir, const char* name) {
    if (value == 0.0) value = in_tir;
    if (value > 0.0 || !f.lacking.empty()) return;
    f.lacking_key = is_tir(path) ? fmt::format("[INERTIA] {}", name) : key;
    f.lacking = is_tir(path) ? "is missing, expected the tire's mass and inertia there, or a tire file in JSON of the "
                               "model handling with the keys tir, mass, spin_inertia and diametral_inertia"
                             : fmt::format("is missing, expected a number above 0 here or {} in [INERTIA] of {}", name,
                                           f.tir.string());
  };
  fill(f.mass, "mass", said.mass, "MASS");
  fill(f.spin_inertia, "spin_inertia", said.iyy, "IYY");
  fill(f.diametral_inertia, "diametral_inertia", said.ixx, "IXX");
  reader.finish();
  return f;
}

std::unique_ptr<TireSpec> read_handling(const json& file, const TireOptions& options) {
  HandlingFile f = read_handling_file(file, options.file.string());
  if (options.rigid) require_inertia(f);
  if (!options.pressure.empty() && f.formula.conditions.nompres > 0.0) {
    if (options.pressure.varies())
      throw input_error(options.file.string(), "tire.pressure",
                        "is a function of time, expected one pressure for a handling tire");
    f.formula.conditions.inflpres = options.pressure.lowest();
  }
  return std::make_unique<HandlingSpec>(std::move(f), options);
}

}  // namespace furrow::tire
