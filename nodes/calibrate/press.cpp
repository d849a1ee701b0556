// Kinds of calibration that press a tire: they fit its file's values to load–deflection curves on plates and cleats.
//
// A target names a CSV file with the columns deflection_m and force_N, as in press.csv of `furrow press`, and
// optionally sigma_N, the force's standard error. Lines of unloading, and lines without deflection, are left out. A
// prediction is the result of `furrow press` for the fitted file, to the tolerance of its solver: both use the tire's
// reader and its static test.
//
// The parameter `softening` of a ring is k₂/√(3 k₁k₃), from 0 to 1; at 1 the sidewall's force would begin to fall.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "nodes/calibrate/kinds.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/csv_file.hpp"
#include "protocol/files/json_text.hpp"
#include "tire/planar/planar_press.hpp"
#include "tire/planar/planar_spec.hpp"
#include "tire/press/press.hpp"
#include "tire/ring/ring_spec.hpp"

namespace furrow::calibrate {
namespace {

using nlohmann::json;

constexpr double kMostDeflection = 0.2;  // m, as of `furrow press`
constexpr double kMostPressure = 1e8;    // Pa
constexpr const char* kSoftening = "softening";

/// Properties of a model whose tire is pressed.
struct PressKind {
  const char* model;  // of the tire's file
  bool has_pressure;  // the inflation pressure can change without changing the tire
  std::span<const ParameterRule> rules;
  std::unique_ptr<tire::TireSpec> (*read)(const json& file, const tire::TireOptions& options);
  double (*most_deflection)(const json& file);  // by which the tire can be pressed, m
  const char* most_text;                        // description of this limit
};

const auto kRingRules = std::to_array<ParameterRule>({
    {"bending", "N/m", 1e-9, 1e12, 1.0, 1e6, true, "/bending"},
    {"shear", "N/m", 1e-9, 1e12, 1e2, 1e8, true, "/shear"},
    {"tangential", "N/m", 1e-9, 1e12, 1e3, 1e7, true, "/tangential"},
    {"sidewall_1", "N/m", 1e-9, 1e12, 1e4, 1e8, true, "/sidewall/0"},
    {"sidewall_2", "N/m²", 0.0, 1e15, 0.0, 1e9, false, "/sidewall/1"},
    {"sidewall_3", "N/m³", 0.0, 1e18, 1e4, 1e11, true, "/sidewall/2"},
    {kSoftening, "-", 0.0, 1.0, 0.0, 1.0, false},
    {"air_share", "-", 1e-6, 1.0, 0.05, 1.0, false, "/air_share"},
    {"tension_share", "-", 0.0, 1.0, 0.0, 1.0, false, "/tension_share"},
    {"width", "m", 1e-3, 5.0, 0.05, 0.5, false, "/width"},
});
const PressKind kRing{
    "ring",
    true,
    kRingRules,
    tire::read_ring,
    [](const json& file) { return tire::kMostRingDeflection * tire::read_ring_file(file, "").params.radius; },
    "a quarter of the tire's radius"};

const auto kPlanarRules = std::to_array<ParameterRule>({
    {"young_modulus", "Pa", 1.0, 1e12, 1e4, 1e8, true, "/tire/young_modulus"},
    {"poisson_ratio", "-", 0.0, 0.499, 0.0, 0.49, false, "/tire/poisson_ratio"},
    {"disc_young_modulus", "Pa", 1.0, 1e13, 1e6, 1e11, true, "/disc/young_modulus"},
    {"contact_stiffness", "N/m²", 1.0, 1e12, 1e5, 1e9, true, "/contact_stiffness"},
});
const PressKind kPlanar{"planar",
                        false,
                        kPlanarRules,
                        tire::read_planar,
                        [](const json& file) {
                          const auto& size = tire::read_planar_file(file, "").params.size;
                          return tire::kMostPlanarDeflection * (size.radius - size.rim_radius);
                        },
                        "0.6 of the tire's height over its rim"};
static_assert(tire::kMostRingDeflection == 0.25 && tire::kMostPlanarDeflection == 0.6, "as most_text says");

/// A target and the surface on which the tire is pressed.
struct PressTarget {
  tire::PressOptions options;
  std::optional<double> pressure;  // Pa; none: the file's
};

tire::PressObstacle obstacle_of(OrderedJsonReader& reader, std::string& what) {
  tire::PressObstacle obstacle;
  const std::string on = reader.text("on");
  if (on != "plate" && on != "cleat") reader.fail("on", "is '" + on + "', expected 'plate' or 'cleat'");
  for (const char* key : {"cleat_width", "cleat_height", "cleat_position"}) {
    if (takes(reader, key) && on == "plate")
      reader.fail(key, "is given on a plate, expected it with \"on\": \"cleat\"");
  }
  what = on;
  if (on == "plate") return obstacle;
  const auto within = [&](const char* key, double least, double most, double otherwise) {
    const double value = reader.given(key) ? reader.number(key) : otherwise;
    if (!(value > least && value <= most))
      reader.fail(key, "is {} m, expected above {} up to {} m", number_text(value), number_text(least),
                  number_text(most));
    return value;
  };
  if (!reader.given("cleat_width")) reader.fail("cleat_width", "is missing, expected the width of the cleat, m");
  obstacle.width = within("cleat_width", 0.0, 1.0, 0.0);
  obstacle.height = within("cleat_height", 0.0, 0.2, 0.1);
  obstacle.position = within("cleat_position", -1.0, 1.0, 0.0);
  what = fmt::format("cleat {:g} mm", 1e3 * obstacle.width);
  return obstacle;
}

/// Deflections and forces of the loading, by rising deflection, with their errors if the file has them.
/// @param most deflection by which the tire can be pressed, m @param most_text describes this limit
std::vector<double> read_curve(Target& target, double most, const char* most_text) {
  const CsvFile table(target.data, "a load–deflection curve in CSV",
                      {"deflection_m", "force_N", "sigma_N", "residual", "unloading", "moment_x_Nm", "moment_y_Nm"});
  if (!table.has("force_N")) throw table.wrong(0, "has no column 'force_N' above it, expected one");
  std::vector<double> sigma;
  std::size_t last = 0;
  double largest = 0.0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (table.has("unloading") && table.number(row, "unloading") != 0.0) continue;
    const double deflection = table.number(row, "deflection_m");
    if (deflection < 0.0 || deflection > kMostDeflection)
      throw table.wrong(row, fmt::format("deflection_m is {}, expected 0 to {}", number_text(deflection),
                                         number_text(kMostDeflection)));
    if (deflection > most)
      throw table.wrong(row, fmt::format("deflection_m is {}, expected {:.4g} or less, {}", number_text(deflection),
                                         most, most_text));
    if (deflection == 0.0) continue;
    if (!target.x.empty() && !(deflection > target.x.back()))
      throw table.wrong(row, fmt::format("deflection_m is {}, expected more than that of the line before, {}",
                                         number_text(deflection), number_text(target.x.back())));
    const double force = table.number(row, "force_N");
    if (force < 0.0)
      throw table.wrong(
          row, fmt::format("force_N is {}, expected 0 or more: a tire is pressed, not pulled", number_text(force)));
    last = row, largest = std::max(largest, force);
    target.x.push_back(deflection), target.y.push_back(force);
    if (!table.has("sigma_N")) continue;
    sigma.push_back(table.number(row, "sigma_N"));
    if (!(sigma.back() > 0.0)) throw table.wrong(row, "sigma_N is " + number_text(sigma.back()) + ", expected above 0");
  }
  if (target.x.empty())
    throw input_error(target.data.string(), "", "has no point of loading with a deflection above 0");
  if (largest == 0.0)
    throw table.wrong(last,
                      "force_N is 0 here and on all lines before, expected a force that rises with the deflection");
  return sigma;
}

class PressModel final : public CalibrationModel {
 public:
  PressModel(const PressKind& kind, CalibrationInput& input)
      : CalibrationModel(input), kind_(kind), file_(load_json(start_, "a tire file in JSON")) {
    if (!file_.contains("model") || file_["model"] != kind.model)
      throw input_error(start_.string(), "model", "is not '{}', expected the file of such a tire in 'start' of {}",
                        kind.model, input.study.string());
    (void)kind_.read(file_, options_for({}));
    if (fits(kSoftening) && fits("sidewall_2"))
      throw input_error(input.study.string(), std::string("parameters.") + kSoftening,
                        "is given with sidewall_2, expected one of them: softening is k2/√(3 k1 k3)");
    for (const TargetSet set : kBothSets)
      for (OrderedJsonReader& reader : input.targets[set]) read(reader, input.study, set);
  }

  std::vector<double> start_values() const override {
    std::vector<double> values;
    for (const std::string& name : names_)  // a file may omit a share that is 0
      values.push_back(name == kSoftening ? softening() : file_.value(place_of(name), 0.0));
    return values;
  }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    Prediction found;
    const json file = document(values);
    try {
      for (const PressTarget& target : presses_[set]) {
        const auto test = kind_.read(file, options_for(target.pressure))->static_test();
        const tire::PressResults results = test->press(target.options, progress);
        for (std::size_t k = 1; k < results.loading.size(); ++k) found.values.push_back(results.loading[k].force);
      }
    } catch (const Error& error) {
      if (error.code() != ExitCode::bad_input && error.code() != ExitCode::physics) throw;
      found.values.clear();
      found.problem = error.what();
    }
    return found;
  }

  nlohmann::ordered_json fitted_file(std::span<const double> values, const std::string& source) const override {
    // The start file's keys in their order, with the fitted values.
    nlohmann::ordered_json ordered = load_json<nlohmann::ordered_json>(start_, "a tire file in JSON");
    const json fitted = document(values);
    for (const auto& [key, value] : fitted.items()) ordered[key] = value;
    ordered["source"] = source;
    return ordered;
  }

 private:
  tire::TireOptions options_for(std::optional<double> pressure) const {
    tire::TireOptions options;
    options.file = start_;
    if (pressure) options.pressure.knots = {{0.0, *pressure}};
    return options;
  }

  json::json_pointer place_of(const std::string& name) const {
    const auto rule =
        std::find_if(kind_.rules.begin(), kind_.rules.end(), [&](const auto& r) { return r.name == name; });
    return json::json_pointer(rule->place);
  }

  // s = k₂/√(3 k₁k₃)
  double softening() const {
    const json& k = file_["sidewall"];
    const double product = 3.0 * k[0].get<double>() * k[2].get<double>();
    return product > 0.0 ? std::min(k[1].get<double>() / std::sqrt(product), 1.0) : NAN;
  }

  void read(OrderedJsonReader& reader, const std::filesystem::path& study, TargetSet set) {
    TargetKeys keys = read_target_keys(reader, study);
    Target& target = keys.target;
    PressTarget press;
    press.options.obstacle = obstacle_of(reader, target.what);
    if (takes(reader, "pressure")) {
      if (!kind_.has_pressure)
        reader.fail("pressure", "is given for a {} tire, whose material stands for one pressure", kind_.model);
      press.pressure = reader.not_negative("pressure");
      if (*press.pressure > kMostPressure)
        reader.fail("pressure", "is {} Pa, expected 0 to {} Pa", number_text(*press.pressure),
                    number_text(kMostPressure));
      target.what += fmt::format(", {:g} kPa", 1e-3 * *press.pressure);
      for (const scenario::Problem& odd :
           scenario::Schema::of_scenarios().unusual({{"tire", {{"pressure", *press.pressure}}}}))
        notes_.emplace_back(input_error(study.string(), reader.full("pressure"), odd.what).what());
    }
    reader.finish();
    target.x_name = "deflection_m", target.y_name = "force_N";
    set_sigma(keys, read_curve(target, kind_.most_deflection(file_), kind_.most_text));
    press.options.unload = false;
    press.options.at = target.x;
    press.options.points = static_cast<int>(target.x.size());
    press.options.deflection = target.x.back();
    press.options.deflection_from = target.data.string(), press.options.deflection_key = "deflection_m";
    press.options.load = std::numeric_limits<double>::infinity();
    target.state =
        fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g}", kind_.model, press.options.obstacle.height,
                    press.options.obstacle.width, press.options.obstacle.position, press.pressure.value_or(-1.0));
    targets_[set].push_back(target);
    presses_[set].push_back(press);
  }

  json document(std::span<const double> values) const {
    json file = file_;
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (names_[k] != kSoftening) file[place_of(names_[k])] = values[k];
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (names_[k] != kSoftening) continue;
      json& wall = file["sidewall"];
      // Slightly below 1, because the reader's own product may round the other way.
      const double s = std::min(values[k], 1.0 - 1e-12);
      wall[1] = s * std::sqrt(3.0 * wall[0].get<double>() * wall[2].get<double>());
    }
    return file;
  }

  const PressKind& kind_;
  json file_;
  PerSet<std::vector<PressTarget>> presses_;
};

template <const PressKind& kKind>
std::unique_ptr<CalibrationModel> read_press(CalibrationInput& input) {
  return std::make_unique<PressModel>(kKind, input);
}

}  // namespace

CalibrationKind ring_kind() { return {"ring", "a tire file", kRingRules, read_press<kRing>, optimize_smooth}; }
CalibrationKind planar_kind() { return {"planar", "a tire file", kPlanarRules, read_press<kPlanar>, optimize_smooth}; }

}  // namespace furrow::calibrate
