// The kind of calibration that fits the Magic Formula of a tire property file (.tir) to tables of `furrow sweep` on
// hard ground (tire/handling/sweep_table.hpp): longitudinal slip, slip angle, camber and load against forces and
// moments.
//
// A target names a table and the compared quantity: "of": "fx", "fy", "mx", "my", "mz" (ISO-W axes), "loaded_radius",
// or "rolling_radius" of freely rolling rows. Parameters are coefficients by their names in the file. In addition to
// the tire file, which names them, the calibration writes a fitted .tir and the tables in the layout of TYDEX (.tdx).
// Both state the fitted ranges of slips and load, and the residuals.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "nodes/calibrate/kinds.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/calibrate/statistics.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/handling/handling_spec.hpp"
#include "tire/handling/sweep_table.hpp"
#include "tire/handling/tir_file.hpp"
#include "tire/handling/tydex.hpp"

namespace furrow::calibrate {
namespace {

using tire::handling::HandlingForces, tire::handling::MagicFormula;
using tire::handling::SweepPoint;

constexpr double kMost = 1e9;          // largest magnitude of a coefficient
constexpr std::size_t kColumns = 110;  // of comments

struct ForceQuantity {
  std::string_view name;
  const char* column;  // of fit.csv
  const char* unit;
  bool free_rolling;  // for such rows alone
  double (*measured)(const SweepPoint& point);
  double (*said)(const MagicFormula& tire, const SweepPoint& point);
};

template <double HandlingForces::*kForce>
double measured(const SweepPoint& p) {
  return p.forces.*kForce;
}
template <double HandlingForces::*kForce>
double said(const MagicFormula& tire, const SweepPoint& p) {
  return tire::handling::evaluate_formula(tire, p.state).*kForce;
}

/// R_l = R_0 − ρ with F_z = F(ρ)/cos γ (tire/handling/rolling_contact.hpp).
double loaded_radius(const MagicFormula& tire, const SweepPoint& p) {
  return tire.dimension.unloaded_radius -
         tire::handling::spring_deflection(tire, p.state.load * std::cos(p.state.camber));
}

double rolling_radius(const MagicFormula& tire, const SweepPoint& p) {
  return tire::handling::rolling_radius(tire, tire::handling::spring_deflection(tire, p.state.load));
}

constexpr auto kForceQuantities = std::to_array<ForceQuantity>({
    {"fx", "Fx_N", "N", false, measured<&HandlingForces::fx>, said<&HandlingForces::fx>},
    {"fy", "Fy_N", "N", false, measured<&HandlingForces::fy>, said<&HandlingForces::fy>},
    {"mx", "Mx_Nm", "N m", false, measured<&HandlingForces::mx>, said<&HandlingForces::mx>},
    {"my", "My_Nm", "N m", false, measured<&HandlingForces::my>, said<&HandlingForces::my>},
    {"mz", "Mz_Nm", "N m", false, measured<&HandlingForces::mz>, said<&HandlingForces::mz>},
    {"loaded_radius", "loaded_radius_m", "m", false, [](const SweepPoint& p) { return p.loaded_radius; },
     loaded_radius},
    {"rolling_radius", "rolling_radius_m", "m", true, [](const SweepPoint& p) { return p.rolling_radius; },
     rolling_radius},
});

/// Bounds if a study gives none: those of usual tires if the coefficient has usual values.
ParameterRule rule_of(const std::string& name, const std::string& unit) {
  static const std::map<std::string, std::pair<double, double>> kUsual{{"PCX1", {1.0, 2.0}},
                                                                       {"PCY1", {1.0, 2.0}},
                                                                       {"QCZ1", {0.8, 2.0}},
                                                                       {"PDX1", {0.1, 2.0}},
                                                                       {"PDY1", {0.1, 2.0}},
                                                                       {"PKX1", {1.0, 200.0}},
                                                                       {"PKY1", {-200.0, -1.0}},
                                                                       {"PKY2", {0.2, 20.0}},
                                                                       {"PEX1", {-20.0, 1.0}},
                                                                       {"PEY1", {-20.0, 1.0}},
                                                                       {"QEZ1", {-20.0, 1.0}},
                                                                       {"RCX1", {0.5, 2.0}},
                                                                       {"RCY1", {0.5, 2.0}},
                                                                       {"RBX1", {0.0, 100.0}},
                                                                       {"RBY1", {0.0, 100.0}},
                                                                       {"VERTICAL_STIFFNESS", {1e4, 1e7}},
                                                                       {"UNLOADED_RADIUS", {0.05, 2.0}}};
  const auto usual = kUsual.find(name);
  const auto [lower, upper] = usual != kUsual.end() ? usual->second : std::pair{-10.0, 10.0};
  return {name, unit, -kMost, kMost, lower, upper, false};
}

double* coefficient(MagicFormula& tire, const std::string& name) {
  double* found = nullptr;
  visit_coefficients(tire, [&](double& value, const Field& field) { found = name == field.name ? &value : found; });
  return found;
}

/// The quantity and the rows that a target compares.
struct Rows {
  const ForceQuantity* quantity = nullptr;
  std::vector<SweepPoint> points;
};

std::string label_of(const SweepPoint& p) {
  return fmt::format("{:.0f} N slip {:.4f} angle {:.4f} camber {:.4f}", p.state.load, p.state.slip, p.state.slip_angle,
                     p.state.camber);
}

class HandlingModel final : public CalibrationModel {
 public:
  explicit HandlingModel(CalibrationInput& input) : CalibrationModel(input), stem_(start_.stem().string() + "_fitted") {
    if (!tire::is_tir(start_))
      throw input_error(input.study.string(), "start", "is '{}', expected a tire property file (.tir)",
                        start_.filename().string());
    formula_ = tire::handling::read_tir(start_);
    for (const TargetSet set : kBothSets)
      for (OrderedJsonReader& reader : input.targets[set]) read(reader, input.study, set);
  }

  std::vector<double> start_values() const override {
    MagicFormula tire = formula_;
    std::vector<double> values;
    for (const std::string& name : names_) values.push_back(*coefficient(tire, name));
    return values;
  }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall&) override {
    const MagicFormula tire = with(values);
    Prediction found;
    for (const Rows& rows : rows_[set])
      for (const SweepPoint& point : rows.points) {
        found.values.push_back(rows.quantity->said(tire, point));
        if (!std::isfinite(found.values.back())) return {{}, {}, "the formula has no value at " + label_of(point)};
      }
    return found;
  }

  nlohmann::ordered_json fitted_file(std::span<const double>, const std::string& source) const override {
    return {{"format_version", 1}, {"model", "handling"}, {"source", source}, {"tir", stem_ + ".tir"}};
  }

  std::vector<ResultFile> further_files(std::span<const double> values, const std::string& source) const override {
    const MagicFormula tire = ranged(with(values));
    std::vector<std::string> comments = lines_of(source);
    comments.push_back(fmt::format(
        "fitted ranges: slip to {:.3g}, slip angle to {:.3g} rad, camber to {:.3g} rad, load {:.0f} to {:.0f} N",
        tire.slip.most, tire.slip_angle.most, tire.camber.most, tire.load.least, tire.load.most));
    std::vector<SweepPoint> points;
    std::set<std::filesystem::path> tables;
    for (std::size_t k = 0; k < rows_.fitted.size(); ++k) {
      const Rows& rows = rows_.fitted[k];
      const Target& target = targets_.fitted[k];
      comments.push_back(residual_text(tire, target, rows));
      if (!rows.quantity->free_rolling && tables.insert(target.data).second)
        points.insert(points.end(), rows.points.begin(), rows.points.end());
    }
    return {{stem_ + ".tir", tire::handling::tir_text(tire, comments)},
            {stem_ + ".tdx", tire::handling::tydex_text(stem_, tire, points, comments)}};
  }

 private:
  MagicFormula with(std::span<const double> values) const {
    MagicFormula tire = formula_;
    for (std::size_t k = 0; k < names_.size(); ++k) *coefficient(tire, names_[k]) = values[k];
    return tire;
  }

  /// Sets the ranges to those of the fitted tables, instead of the start's.
  MagicFormula ranged(MagicFormula tire) const {
    bool first = true;
    const auto take = [&](tire::handling::Range& range, double value) {
      range.least = first ? value : std::min(range.least, value);
      range.most = first ? value : std::max(range.most, value);
    };
    for (const Rows& rows : rows_.fitted)
      for (const SweepPoint& p : rows.points) {
        take(tire.slip, p.state.slip), take(tire.slip_angle, p.state.slip_angle);
        take(tire.camber, p.state.camber), take(tire.load, p.state.load);
        first = false;
      }
    // A table may cover only one side, but a tire has both.
    for (tire::handling::Range* range : {&tire.slip, &tire.slip_angle, &tire.camber}) {
      const double most = std::max({1e-3, -range->least, range->most});
      *range = {-most, most};
    }
    return tire;
  }

  /// Breaks a text into lines that fit a page.
  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word; lines.back() += (lines.back().empty() ? "" : " ") + word)
      if (lines.back().size() + word.size() > kColumns) lines.emplace_back();
    return lines;
  }

  static std::string residual_text(const MagicFormula& tire, const Target& target, const Rows& rows) {
    std::vector<double> said;
    for (const SweepPoint& point : rows.points) said.push_back(rows.quantity->said(tire, point));
    const Goodness g = goodness(target, said);
    return fmt::format(
        "residual of {0}: root mean square {1:.3g} {4}, largest {2:.3g} {4} of a peak of {3:.4g} {4}, {5} points",
        target.name, g.root_mean_square, g.largest_error, g.peak, rows.quantity->unit, said.size());
  }

  void read(OrderedJsonReader& reader, const std::filesystem::path& study, TargetSet set) {
    TargetKeys keys = read_target_keys(reader, study);
    Target& target = keys.target;
    const std::string of = reader.text("of");
    Rows rows;
    rows.quantity = &entry_named(kForceQuantities, of,
                                 [&](const std::string& what) { return reader.wrong("of", "'" + of + "' " + what); });
    if (!reader.given("name")) target.name += "_" + of;
    reader.finish();
    for (const SweepPoint& point : tire::handling::read_sweep_table(target.data)) {
      if (rows.quantity->free_rolling && !point.rolls_freely) continue;
      rows.points.push_back(point);
      target.x.push_back(static_cast<double>(rows.points.size()));
      target.y.push_back(rows.quantity->measured(point));
      target.labels.push_back(label_of(point));
    }
    target.what = fmt::format("{} of {} rows", of, rows.points.size());
    target.x_name = "row", target.y_name = rows.quantity->column;
    set_sigma(keys, {});
    target.state = fmt::format("handling {} {}", of, file_hash(target.data));
    targets_[set].push_back(target);
    rows_[set].push_back(std::move(rows));
  }

  std::string stem_;  // of the files that it writes
  MagicFormula formula_;
  PerSet<std::vector<Rows>> rows_;
};

std::vector<ParameterRule> rules_of_coefficients() {
  std::vector<ParameterRule> all;
  const MagicFormula none;
  visit_coefficients(none, [&](const double&, const Field& field) { all.push_back(rule_of(field.name, field.unit)); });
  return all;
}

}  // namespace

CalibrationKind handling_kind() {
  static const std::vector<ParameterRule> rules = rules_of_coefficients();
  return {"handling", "a tire property file (.tir)", rules, read_model<HandlingModel>, optimize_smooth};
}

}  // namespace furrow::calibrate
