#include "nodes/calibrate/handling.hpp"
#include "nodes/calibrate/files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/handling/handling_spec.hpp"
#include "tire/handling/sweep_table.hpp"
#include "tire/handling/tir_file.hpp"
#include "tire/handling/tydex.hpp"

namespace furrow::calibrate {
namespace {

using tire::handling::MagicFormula;
using tire::handling::SweepPoint;

constexpr double kMost = 1e9;          // of any coefficient's size
constexpr std::size_t kColumns = 110;  // of comments

/// What of a table is compared.
struct Quantity {
  std::string_view name;
  const char* column;  // of fit.csv
  const char* unit;
  bool free_rolling;  // of such rows alone
  double (*measured)(const SweepPoint& point);
  double (*said)(const MagicFormula& tire, const SweepPoint& point);
};

tire::handling::HandlingForces forces(const MagicFormula& tire, const SweepPoint& p) {
  return tire::handling::evaluate_formula(tire, p.state);
}

/// R_l = R_0 − ρ with F_z = C_z ρ/cos γ (tire/handling/rolling_contact.hpp).
double loaded_radius(const MagicFormula& tire, const SweepPoint& p) {
  return tire.dimension.unloaded_radius - p.state.load * std::cos(p.state.camber) / tire.vertical.vertical_stiffness;
}

constexpr auto kQuantities = std::to_array<Quantity>({
    {"fx", "Fx_N", "N", false, [](const SweepPoint& p) { return p.forces.fx; },
     [](const MagicFormula& t, const SweepPoint& p) { return forces(t, p).fx; }},
    {"fy", "Fy_N", "N", false, [](const SweepPoint& p) { return p.forces.fy; },
     [](const MagicFormula& t, const SweepPoint& p) { return forces(t, p).fy; }},
    {"mx", "Mx_Nm", "N m", false, [](const SweepPoint& p) { return p.forces.mx; },
     [](const MagicFormula& t, const SweepPoint& p) { return forces(t, p).mx; }},
    {"my", "My_Nm", "N m", false, [](const SweepPoint& p) { return p.forces.my; },
     [](const MagicFormula& t, const SweepPoint& p) { return forces(t, p).my; }},
    {"mz", "Mz_Nm", "N m", false, [](const SweepPoint& p) { return p.forces.mz; },
     [](const MagicFormula& t, const SweepPoint& p) { return forces(t, p).mz; }},
    {"loaded_radius", "loaded_radius_m", "m", false, [](const SweepPoint& p) { return p.loaded_radius; },
     loaded_radius},
    {"rolling_radius", "rolling_radius_m", "m", true, [](const SweepPoint& p) { return p.rolling_radius; },
     [](const MagicFormula& t, const SweepPoint& p) {
       return tire::handling::rolling_radius(t, p.state.load / t.vertical.vertical_stiffness);
     }},
});

/// Bounds where a study gives none: those of usual tires for what has usual values.
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
  visit_coefficients([&](const Field& field, double& value) { found = name == field.name ? &value : found; }, tire);
  return found;
}

/// Numbers of a target: which quantity of which rows.
struct Rows {
  std::string target;  // its name
  std::filesystem::path data;
  const Quantity* quantity = nullptr;
  std::vector<SweepPoint> points;
};

std::string label_of(const SweepPoint& p) {
  return fmt::format("{:.0f} N slip {:.4f} angle {:.4f} camber {:.4f}", p.state.load, p.state.slip, p.state.slip_angle,
                     p.state.camber);
}

class HandlingModel final : public CalibrationModel, public LeavesFiles {
 public:
  explicit HandlingModel(CalibrationInput& input)
      : names_(input.parameters), start_(input.start), stem_(input.start.stem().string() + "_fitted") {
    if (!tire::is_tir(start_))
      throw input_error(input.study.string(), "start",
                        fmt::format("is '{}', expected a tire property file (.tir)", start_.filename().string()));
    formula_ = tire::handling::read_tir(start_);
    read(input.targets, input.study, fitted_, of_fitted_);
    read(input.held_out, input.study, held_out_, of_held_out_);
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
    for (const Rows& rows : set == TargetSet::fitted ? of_fitted_ : of_held_out_)
      for (const SweepPoint& point : rows.points) {
        found.values.push_back(rows.quantity->said(tire, point));
        if (std::isfinite(found.values.back())) continue;
        found.values.clear();
        found.problem = "the formula has no value at " + label_of(point);
        return found;
      }
    return found;
  }

  nlohmann::ordered_json fitted_file(std::span<const double>, const std::string& source) const override {
    nlohmann::ordered_json file{
        {"format_version", 1}, {"model", "handling"}, {"source", source}, {"tir", stem_ + ".tir"}};
    return file;
  }

  std::vector<ResultFile> further_files(std::span<const double> values, const std::string& source) const override {
    const MagicFormula tire = ranged(with(values));
    std::vector<std::string> comments = lines_of(source);
    comments.push_back("fitted ranges: " + ranges_text(tire));
    for (std::size_t k = 0; k < of_fitted_.size(); ++k) comments.push_back(residual_text(tire, of_fitted_[k]));
    std::vector<SweepPoint> points;
    std::set<std::filesystem::path> tables;
    for (const Rows& rows : of_fitted_)
      if (!rows.quantity->free_rolling && tables.insert(rows.data).second)
        points.insert(points.end(), rows.points.begin(), rows.points.end());
    return {{stem_ + ".tir", tire::handling::tir_text(tire, comments)},
            {stem_ + ".tdx", tire::handling::tydex_text(stem_, tire, points, comments)}};
  }

 private:
  MagicFormula with(std::span<const double> values) const {
    MagicFormula tire = formula_;
    for (std::size_t k = 0; k < names_.size(); ++k) *coefficient(tire, names_[k]) = values[k];
    return tire;
  }

  /// The ranges of the fitted tables, in place of the start's.
  MagicFormula ranged(MagicFormula tire) const {
    bool first = true;
    const auto take = [&](tire::handling::Range& range, double value) {
      range.least = first ? value : std::min(range.least, value);
      range.most = first ? value : std::max(range.most, value);
    };
    for (const Rows& rows : of_fitted_)
      for (const SweepPoint& p : rows.points) {
        take(tire.slip, p.state.slip), take(tire.slip_angle, p.state.slip_angle);
        take(tire.camber, p.state.camber), take(tire.load, p.state.load);
        first = false;
      }
    // A table may have one side alone: a tire has both.
    for (tire::handling::Range* range : {&tire.slip, &tire.slip_angle, &tire.camber}) {
      const double most = std::max({1e-3, -range->least, range->most});
      *range = {-most, most};
    }
    return tire;
  }

  /// Words of a text in lines that fit a page.
  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word; lines.back() += (lines.back().empty() ? "" : " ") + word)
      if (lines.back().size() + word.size() > kColumns) lines.emplace_back();
    return lines;
  }

  static std::string ranges_text(const MagicFormula& t) {
    return fmt::format("slip to {:.3g}, slip angle to {:.3g} rad, camber to {:.3g} rad, load {:.0f} to {:.0f} N",
                       t.slip.most, t.slip_angle.most, t.camber.most, t.load.least, t.load.most);
  }

  static std::string residual_text(const MagicFormula& tire, const Rows& rows) {
    double squares = 0.0, largest = 0.0, peak = 0.0;
    for (const SweepPoint& p : rows.points) {
      const double measured = rows.quantity->measured(p), residual = rows.quantity->said(tire, p) - measured;
      squares += residual * residual;
      largest = std::max(largest, std::abs(residual));
      peak = std::max(peak, std::abs(measured));
    }
    return fmt::format(
        "residual of {}: root mean square {:.3g} {}, largest {:.3g} {} of a peak of {:.4g} {}, {} points", rows.target,
        std::sqrt(squares / static_cast<double>(rows.points.size())), rows.quantity->unit, largest, rows.quantity->unit,
        peak, rows.quantity->unit, rows.points.size());
  }

  static const Quantity& quantity_of(OrderedJsonReader& reader) {
    const std::string name = reader.text("of");
    std::vector<std::string> known;
    for (const Quantity& quantity : kQuantities) {
      if (quantity.name == name) return quantity;
      known.emplace_back(quantity.name);
    }
    reader.fail("of", fmt::format("is '{}', expected {}", name, one_of(known)));
  }

  void read(std::vector<OrderedJsonReader>& readers, const std::filesystem::path& study, std::vector<Target>& targets,
            std::vector<Rows>& all) {
    for (OrderedJsonReader& reader : readers) {
      TargetKeys keys = read_target_keys(reader, study);
      Target& target = keys.target;
      Rows rows;
      rows.quantity = &quantity_of(reader);
      if (!reader.given("name")) target.name += "_" + std::string(rows.quantity->name);
      reader.finish();
      for (const SweepPoint& point : tire::handling::read_sweep_table(target.data)) {
        if (rows.quantity->free_rolling && !point.rolls_freely) continue;
        rows.points.push_back(point);
        target.x.push_back(static_cast<double>(rows.points.size()));
        target.y.push_back(rows.quantity->measured(point));
        target.labels.push_back(label_of(point));
      }
      target.what = fmt::format("{} of {} rows", rows.quantity->name, rows.points.size());
      target.x_name = "row", target.y_name = rows.quantity->column;
      rows.target = target.name, rows.data = target.data;
      set_sigma(keys, {});
      target.state = fmt::format("handling {} {}", rows.quantity->name, file_hash(target.data));
      targets.push_back(target);
      all.push_back(std::move(rows));
    }
  }

  std::vector<std::string> names_;
  std::filesystem::path start_;
  std::string stem_;  // of the files that it leaves
  MagicFormula formula_;
  std::vector<Rows> of_fitted_, of_held_out_;
};

}  // namespace

std::span<const ParameterRule> handling_parameters() {
  static const std::vector<ParameterRule> rules = [] {
    std::vector<ParameterRule> all;
    const MagicFormula none;
    visit_coefficients([&](const Field& field, const double&) { all.push_back(rule_of(field.name, field.unit)); },
                       none);
    return all;
  }();
  return rules;
}

std::unique_ptr<CalibrationModel> read_handling_calibration(CalibrationInput& input) {
  return std::make_unique<HandlingModel>(input);
}

}  // namespace furrow::calibrate
