#include "nodes/calibrate/scm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "nodes/scenario/soil_material.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/files/csv_file.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/scm/janosi_shear.hpp"
#include "terrain/scm/pressure_sinkage.hpp"
#include "terrain/scm/scm_options.hpp"
#include "terrain/soil/fits.hpp"
#include "terrain/terrains.hpp"

namespace furrow::calibrate {
namespace {

using nlohmann::json;
using terrain::scm::ScmOptions;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kNoSlip = 1e9;  // friction of the shear box against the soil: it never slips

const auto kRules = std::to_array<ParameterRule>({
    {"bekker_k_c", "N/m^(n+1)", -1e12, 1e12, -1e6, 1e6, false},
    {"bekker_k_phi", "N/m^(n+2)", 1e-6, 1e13, 1e3, 1e9, true},
    {"bekker_n", "-", 1e-3, 5.0, 0.05, 2.0, false},
    {"mohr_cohesion", "Pa", 0.0, 1e9, 0.0, 1e5, false},
    {"mohr_friction_angle", "deg", 0.0, 80.0, 0.0, 60.0, false},
    {"janosi_k", "m", 1e-6, 10.0, 1e-4, 0.2, true},
});

/// A curve of one plate or under one normal stress.
struct Curve {
  bool plate = false;
  double width = 0.0;          // of the plate's smaller side, m
  std::vector<double> normal;  // under which is sheared, Pa
};

/// One test of a file: its points, by what tells curves apart.
struct Points {
  std::vector<double> x, y, sigma, normal;
};

class ScmModel final : public CalibrationModel {
 public:
  explicit ScmModel(CalibrationInput& input) : names_(input.parameters), start_(input.start) {
    const json soil = scenario::read_soil_material(input.start);
    visit_fields(
        [&](const Field& field, auto& value) {
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
            if (field.is(role::soil) && soil.contains(field.name) && soil.at(field.name).is_number()) {
              value = soil.at(field.name).template get<double>();
              given_.push_back(field.name);
            }
        },
        soil_);
    for (OrderedJsonReader& reader : input.targets) read(reader, input.study, fitted_, of_fitted_);
    for (OrderedJsonReader& reader : input.held_out) read(reader, input.study, held_out_, of_held_out_);
  }

  std::vector<double> start_values() const override {
    const std::map<std::string, double> fits = fits_of_curves();
    std::vector<double> values;
    for (const std::string& name : names_) {
      double value = NAN;
      if (std::find(given_.begin(), given_.end(), name) != given_.end())
        with(soil_, name, [&](double own) { value = own; });
      else if (const auto fit = fits.find(name); fit != fits.end())
        value = fit->second;
      values.push_back(value);
    }
    return values;
  }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    if (progress) progress("", 0.0);
    ScmOptions soil = soil_;
    for (std::size_t k = 0; k < names_.size(); ++k) with(soil, names_[k], [&](double& own) { own = values[k]; });
    const terrain::scm::PressureLaw pressure{soil.bekker_k_c,
                                             soil.bekker_k_phi,
                                             soil.bekker_n,
                                             soil.unloading_stiffness,
                                             soil.unloading_stiffness_rate,
                                             0.0};
    const terrain::scm::ShearLaw shear{soil.mohr_cohesion, std::tan(soil.mohr_friction_angle * kDegree), soil.janosi_k,
                                       kNoSlip};
    Prediction found;
    const std::vector<Curve>& curves = set == TargetSet::fitted ? of_fitted_ : of_held_out_;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const std::vector<double>& x = targets(set)[i].x;
      for (std::size_t k = 0; k < x.size(); ++k) {
        if (curves[i].plate) {
          terrain::scm::SoilNode node;
          const double modulus = pressure.modulus(curves[i].width);
          found.values.push_back(terrain::scm::press(pressure, modulus, 0.0, x[k], 0.0, node).pressure);
        } else {
          Vec3 mobilized = Vec3::Zero();
          terrain::scm::shear(shear, Vec3(x[k], 0.0, 0.0), 1.0, mobilized);
          found.values.push_back(shear.limit(curves[i].normal[k]) * mobilized.x());
        }
      }
    }
    return found;
  }

  nlohmann::ordered_json fitted_file(std::span<const double> values, const std::string& source) const override {
    nlohmann::ordered_json file = load_json<nlohmann::ordered_json>(start_, "a soil in JSON");
    file["description"] = source;
    // What the start says to other engines, and what was measured of them, is not of the fitted soil.
    file.erase("measured");
    nlohmann::ordered_json own = nlohmann::ordered_json::object();
    for (const auto& [key, value] : file["terrain"].items()) {
      const std::vector<std::string> engines = terrain::engines_of_key(key);
      if (std::find(engines.begin(), engines.end(), "scm") != engines.end()) own[key] = value;
    }
    file["terrain"] = std::move(own);
    for (std::size_t k = 0; k < names_.size(); ++k) file["terrain"][names_[k]] = values[k];
    return file;
  }

 private:
  /// Calls visit(value) of the key.
  template <class Options, class Visit>
  static void with(Options& options, const std::string& name, Visit visit) {
    visit_fields(
        [&](const Field& field, auto& value) {
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
            if (name == field.name) visit(value);
        },
        options);
  }

  void read(OrderedJsonReader& reader, const std::filesystem::path& study, std::vector<Target>& targets,
            std::vector<Curve>& curves) {
    const TargetKeys keys = read_target_keys(reader, study);
    const std::string on = reader.text("on");
    if (on != "plate" && on != "shear") reader.fail("on", "is '" + on + "', expected 'plate' or 'shear'");
    const bool plate = on == "plate";
    const char *one = plate ? "width" : "normal_stress", *other = plate ? "normal_stress" : "width";
    if (reader.has(other)) reader.fail(other, fmt::format("is given with \"on\": \"{}\", expected {}", on, one));
    reader.skip(one);
    reader.finish();
    for (const auto& [mark, points] : tests_of(keys.target.data, plate, reader, one)) {
      TargetKeys of_curve = keys;
      Target& target = of_curve.target;
      target.name += plate ? fmt::format(" {:g} mm", 1e3 * mark) : fmt::format(" {:g} kPa", 1e-3 * mark);
      target.what = plate ? fmt::format("plate, {:g} mm", 1e3 * mark) : fmt::format("shear, {:g} kPa", 1e-3 * mark);
      target.x_name = plate ? "sinkage_m" : "travel_m";
      target.y_name = plate ? "pressure_Pa" : "stress_Pa";
      target.x = points.x, target.y = points.y;
      set_sigma(of_curve, points.sigma);
      target.state = fmt::format("scm {} {:.17g}", on, mark);
      for (const double stress : points.normal) target.state += fmt::format(" {:.17g}", stress);
      targets.push_back(target);
      curves.push_back({plate, plate ? mark : 0.0, points.normal});
    }
  }

  /// The points of a file by the plate's width or by the nominal normal stress, by rising x. As in `furrow soil` what
  /// has no sinkage or no pressure is left out.
  /// @param key of the target that says it where the file has no such column
  static std::map<double, Points> tests_of(const std::filesystem::path& file, bool plate, OrderedJsonReader& reader,
                                           const char* key) {
    const CsvFile table(file, plate ? "a plate-sinkage test in CSV" : "a shear test in CSV",
                        plate ? std::vector<std::string>{"sinkage_m", "pressure_Pa", "width_m", "seed", "sigma_Pa"}
                              : std::vector<std::string>{"travel_m", "shear_stress_Pa", "normal_stress_Pa",
                                                         "nominal_normal_stress_Pa", "seed", "rise_m", "sigma_Pa"});
    const char *x = plate ? "sinkage_m" : "travel_m", *y = plate ? "pressure_Pa" : "shear_stress_Pa",
               *mark = plate                                   ? "width_m"
                       : table.has("nominal_normal_stress_Pa") ? "nominal_normal_stress_Pa"
                                                               : "normal_stress_Pa";
    if (!table.has(y)) throw table.wrong(0, fmt::format("has no column '{}' above it, expected one", y));
    const bool marked = table.has(mark);
    if (marked && reader.has(key))
      reader.fail(key, fmt::format("is given, and {} has the column '{}', expected one of them",
                                   file.filename().string(), mark));
    if (!marked && !reader.has(key))
      throw table.wrong(
          0, fmt::format("has no column '{}' above it, expected one, or the key '{}' of the target", mark, key));
    const double given = marked ? NAN : reader.positive(key);
    std::map<double, Points> tests;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      const double at = table.number(row, x), value = table.number(row, y),
                   which = marked ? table.number(row, mark) : given;
      if (!(which > 0.0)) throw table.wrong(row, fmt::format("{} is {}, expected above 0", mark, number_text(which)));
      if (!(at > 0.0) || (plate && !(value > 0.0))) continue;
      Points& points = tests[which];
      points.x.push_back(at), points.y.push_back(value);
      if (!plate)
        points.normal.push_back(
            std::max(table.has("normal_stress_Pa") ? table.number(row, "normal_stress_Pa") : which, 0.0));
      if (!table.has("sigma_Pa")) continue;
      points.sigma.push_back(table.number(row, "sigma_Pa"));
      if (!(points.sigma.back() > 0.0))
        throw table.wrong(row, "sigma_Pa is " + number_text(points.sigma.back()) + ", expected above 0");
    }
    if (tests.empty()) throw input_error(file.string(), "", fmt::format("has no point with {} above 0", x));
    for (auto& [unused, points] : tests) sort_points(points);
    return tests;
  }

  static void sort_points(Points& points) {
    std::vector<std::size_t> order(points.x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return points.x[a] < points.x[b]; });
    for (std::vector<double>* values : {&points.x, &points.y, &points.sigma, &points.normal}) {
      if (values->empty()) continue;
      std::vector<double> sorted;
      for (const std::size_t k : order) sorted.push_back((*values)[k]);
      *values = std::move(sorted);
    }
  }

  /// What `furrow soil` makes of the same curves, as far as there are enough of them.
  std::map<std::string, double> fits_of_curves() const {
    std::map<std::string, double> fits;
    std::vector<terrain::soil::PlateCurve> plates;
    std::vector<double> normal, most, K;
    for (std::size_t i = 0; i < of_fitted_.size(); ++i) {
      const Target& target = fitted_[i];
      if (of_fitted_[i].plate) {
        if (target.x.size() >= 2) plates.push_back({of_fitted_[i].width, target.x, target.y});
      } else if (target.x.size() >= 3) {
        const terrain::soil::JanosiFit fit = terrain::soil::fit_janosi(target.x, target.y);
        const std::vector<double>& stress = of_fitted_[i].normal;
        normal.push_back(std::accumulate(stress.begin(), stress.end(), 0.0) / static_cast<double>(stress.size()));
        most.push_back(fit.tau_max), K.push_back(fit.K);
      }
    }
    const auto differ = [](double a, double b) { return a != b; };
    if (std::adjacent_find(plates.begin(), plates.end(),
                           [](const auto& a, const auto& b) { return a.width != b.width; }) != plates.end()) {
      const terrain::soil::BekkerFit fit = terrain::soil::fit_bekker(plates);
      fits["bekker_k_c"] = fit.k_c, fits["bekker_k_phi"] = fit.k_phi, fits["bekker_n"] = fit.n;
    }
    if (!K.empty()) fits["janosi_k"] = std::accumulate(K.begin(), K.end(), 0.0) / static_cast<double>(K.size());
    if (std::adjacent_find(normal.begin(), normal.end(), differ) != normal.end()) {
      const terrain::soil::CoulombFit fit = terrain::soil::fit_coulomb(normal, most);
      fits["mohr_cohesion"] = std::max(fit.cohesion.value, 0.0);
      fits["mohr_friction_angle"] = std::max(fit.phi.value, 0.0) / kDegree;
    }
    return fits;
  }

  std::vector<std::string> names_, given_;
  std::filesystem::path start_;
  ScmOptions soil_;
  std::vector<Curve> of_fitted_, of_held_out_;
};

}  // namespace

std::span<const ParameterRule> scm_parameters() { return kRules; }

std::unique_ptr<CalibrationModel> read_scm_calibration(CalibrationInput& input) {
  return std::make_unique<ScmModel>(input);
}

}  // namespace furrow::calibrate
