// The kind `scm` of calibrations: fits empirical soil (terrain/scm) to the curves of plate and shear tests.
//
// A target names plate.csv or shear.csv of `furrow soil`, or a measured table with the same columns. Each width of a
// plate and each normal stress of a shear test is a target of its own, named after both. Without a start in the study
// or the soil file, parameters start from the fits of `furrow soil` to the same curves (terrain/soil/fits.hpp).
// Parameters are keys of the section `terrain`.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "nodes/calibrate/kinds.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "protocol/core/constants.hpp"
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

constexpr double kSameDepth = 1.1;  // ratio of depths of beds that count as equal
constexpr double kNoSlip = 1e9;     // friction of the shear box on the soil: it never slips

const auto kScmRules = std::to_array<ParameterRule>({
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
  std::vector<double> normal;  // stresses during shearing, Pa
};

struct Point {
  double x, y, sigma, normal;
};

class ScmModel final : public CalibrationModel {
 public:
  explicit ScmModel(CalibrationInput& input) : CalibrationModel(input) {
    const json soil = scenario::read_soil_material(start_);
    for (const auto& [key, value] : soil.items())
      if (double* const own = number_named(soil_, key); own && value.is_number())
        *own = value.get<double>(), given_.push_back(key);
    for (const TargetSet set : kBothSets)
      for (OrderedJsonReader& reader : input.targets[set]) read(reader, input.study, set);
  }

  std::vector<double> start_values() const override {
    std::map<std::string, double> starts = fits_of_curves();
    for (const std::string& name : given_) starts[name] = *number_named(soil_, name);
    std::vector<double> values;
    for (const std::string& name : names_) values.push_back(starts.contains(name) ? starts[name] : NAN);
    return values;
  }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    if (progress) progress("", 0.0);
    ScmOptions soil = soil_;
    for (std::size_t k = 0; k < names_.size(); ++k) *number_named(soil, names_[k]) = values[k];
    const terrain::scm::PressureLaw pressure{soil.bekker_k_c,
                                             soil.bekker_k_phi,
                                             soil.bekker_n,
                                             soil.unloading_stiffness,
                                             soil.unloading_stiffness_rate,
                                             0.0};
    const terrain::scm::ShearLaw shear{soil.mohr_cohesion, std::tan(soil.mohr_friction_angle * kDegree), soil.janosi_k,
                                       kNoSlip};
    Prediction found;
    const std::vector<Curve>& curves = curves_[set];
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
    // The start's keys for other engines, and its measured figures, do not describe the fitted soil.
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
  void read(OrderedJsonReader& reader, const std::filesystem::path& study, TargetSet set) {
    const TargetKeys keys = read_target_keys(reader, study);
    const std::string on = reader.text("on");
    if (on != "plate" && on != "shear") reader.fail("on", "is '" + on + "', expected 'plate' or 'shear'");
    const bool plate = on == "plate";
    const char *one = plate ? "width" : "normal_stress", *other = plate ? "normal_stress" : "width";
    if (reader.has(other)) reader.fail(other, "is given with \"on\": \"{}\", expected {}", on, one);
    reader.skip(one);
    reader.finish();
    for (const auto& [mark, points] : tests_of(keys.target.data, plate, reader, one)) {
      TargetKeys of_curve = keys;
      Target& target = of_curve.target;
      const std::string size = plate ? fmt::format("{:g} mm", 1e3 * mark) : fmt::format("{:g} kPa", 1e-3 * mark);
      target.name += " " + size;
      target.what = on + ", " + size;
      target.x_name = plate ? "sinkage_m" : "travel_m";
      target.y_name = plate ? "pressure_Pa" : "stress_Pa";
      target.state = fmt::format("scm {} {:.17g}", on, mark);
      Curve curve{plate, plate ? mark : 0.0, {}};
      std::vector<double> sigma;
      for (const Point& point : points) {
        target.x.push_back(point.x), target.y.push_back(point.y);
        if (std::isfinite(point.sigma)) sigma.push_back(point.sigma);
        if (plate) continue;
        curve.normal.push_back(point.normal);
        target.state += fmt::format(" {:.17g}", point.normal);
      }
      set_sigma(of_curve, sigma);
      targets_[set].push_back(target);
      curves_[set].push_back(curve);
    }
  }

  /// The points of a file by the plate's width or by the nominal normal stress, by rising x. As in `furrow soil`,
  /// points without sinkage or pressure are left out.
  /// @param key of the target that gives the width or stress if the file has no such column
  static std::map<double, std::vector<Point>> tests_of(const std::filesystem::path& file, bool plate,
                                                       OrderedJsonReader& reader, const char* key) {
    const CsvFile table(file, plate ? "a plate-sinkage test in CSV" : "a shear test in CSV",
                        plate ? std::vector<std::string>{"sinkage_m", "pressure_Pa", "width_m", "seed", "sigma_Pa",
                                                         "diameter_m", "bed_depth_m"}
                              : std::vector<std::string>{"travel_m", "shear_stress_Pa", "normal_stress_Pa",
                                                         "nominal_normal_stress_Pa", "seed", "rise_m", "sigma_Pa"});
    const char *x = plate ? "sinkage_m" : "travel_m", *y = plate ? "pressure_Pa" : "shear_stress_Pa",
               *mark = plate                                   ? "width_m"
                       : table.has("nominal_normal_stress_Pa") ? "nominal_normal_stress_Pa"
                                                               : "normal_stress_Pa";
    if (!table.has(y)) throw table.wrong(0, fmt::format("has no column '{}' above it, expected one", y));
    const bool marked = table.has(mark);
    if (marked && reader.has(key))
      reader.fail(key, "is given, and {} has the column '{}', expected one of them", file.filename().string(), mark);
    if (!marked && !reader.has(key))
      throw table.wrong(
          0, fmt::format("has no column '{}' above it, expected one, or the key '{}' of the target", mark, key));
    const double given = marked ? NAN : reader.positive(key);
    std::map<double, std::vector<Point>> tests;
    double shallowest = INFINITY, deepest = 0.0;
    for (std::size_t row = 0; table.has("bed_depth_m") && row < table.row_count(); ++row) {
      const double depth = table.number(row, "bed_depth_m");
      shallowest = std::min(shallowest, depth), deepest = std::max(deepest, depth);
      if (deepest > kSameDepth * shallowest)
        throw table.wrong(row, fmt::format("bed_depth_m is {} m, and {} m elsewhere, expected plates on beds of one "
                                           "depth: the pressure depends on it",
                                           number_text(depth), number_text(depth == deepest ? shallowest : deepest)));
    }
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      const auto number = [&](const char* column, double otherwise) {
        return table.has(column) ? table.number(row, column) : otherwise;
      };
      const double which = marked ? number(mark, NAN) : given;
      const Point point{number(x, NAN), number(y, NAN), number("sigma_Pa", NAN),
                        std::max(number("normal_stress_Pa", which), 0.0)};
      if (!(which > 0.0)) throw table.wrong(row, fmt::format("{} is {}, expected above 0", mark, number_text(which)));
      if (!(point.x > 0.0) || (plate && !(point.y > 0.0))) continue;
      if (point.sigma <= 0.0) throw table.wrong(row, "sigma_Pa is " + number_text(point.sigma) + ", expected above 0");
      tests[which].push_back(point);
    }
    if (tests.empty()) throw input_error(file.string(), "", "has no point with {} above 0", x);
    for (auto& [unused, points] : tests)
      std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    return tests;
  }

  /// Fits of `furrow soil` to the same curves, if there are enough of them.
  std::map<std::string, double> fits_of_curves() const {
    std::map<std::string, double> fits;
    std::vector<terrain::soil::PlateCurve> plates;
    std::vector<double> normal, most, K;
    const auto mean = [](const std::vector<double>& list) {
      return std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size());
    };
    for (std::size_t i = 0; i < curves_.fitted.size(); ++i) {
      const Target& target = targets_.fitted[i];
      const Curve& curve = curves_.fitted[i];
      if (curve.plate) {
        if (target.x.size() >= 2) plates.push_back({curve.width, target.x, target.y});
      } else if (target.x.size() >= 3) {
        const terrain::soil::JanosiFit fit = terrain::soil::fit_janosi(target.x, target.y);
        normal.push_back(mean(curve.normal)), most.push_back(fit.tau_max), K.push_back(fit.K);
      }
    }
    const auto differ = [](const auto& list, auto of) {
      return std::any_of(list.begin(), list.end(), [&](const auto& one) { return of(one) != of(list.front()); });
    };
    if (differ(plates, [](const auto& plate) { return plate.width; })) {
      const terrain::soil::BekkerFit fit = terrain::soil::fit_bekker(plates);
      fits["bekker_k_c"] = fit.k_c, fits["bekker_k_phi"] = fit.k_phi, fits["bekker_n"] = fit.n;
    }
    if (!K.empty()) fits["janosi_k"] = mean(K);
    if (differ(normal, [](double stress) { return stress; })) {
      const terrain::soil::CoulombFit fit = terrain::soil::fit_coulomb(normal, most);
      fits["mohr_cohesion"] = std::max(fit.cohesion.value, 0.0);
      fits["mohr_friction_angle"] = std::max(fit.phi.value, 0.0) / kDegree;
    }
    return fits;
  }

  std::vector<std::string> given_;
  ScmOptions soil_;
  PerSet<std::vector<Curve>> curves_;
};

}  // namespace

CalibrationKind scm_kind() { return {"scm", "a soil file", kScmRules, read_model<ScmModel>, optimize_smooth}; }

}  // namespace furrow::calibrate
