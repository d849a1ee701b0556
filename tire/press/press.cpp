#include "tire/press/press.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::tire {
namespace {

constexpr double kLoadTolerance = 1e-3;  // of the footprint's load
constexpr int kMaxTrials = 12;
constexpr double kOnePath = 1e-3;       // loading and unloading that differ by less are one path
constexpr double kEdgePressure = 0.02;  // of the largest: the footprint ends at this pressure

/// Finds the deflection that carries the load, between two points of the curve; the solver stays there.
PressPoint find_load(const std::function<PressPoint(double)>& press, PressPoint low, PressPoint high, double load) {
  FURROW_ASSERT(load > low.force && load <= high.force, load, low.force, high.force);
  PressPoint now = high;
  for (int n = 0; n < kMaxTrials && std::abs(now.force - load) > kLoadTolerance * load; ++n) {
    const double share = std::clamp((load - low.force) / (high.force - low.force), 0.02, 0.98);
    now = press(low.deflection + share * (high.deflection - low.deflection));
    (now.force < load ? low : high) = now;
  }
  return now;
}

/// Whether the tangent of the unpressed, inflated tire is positive definite.
bool stable_unpressed(const PressResults& results) { return results.loading.front().failed_factorizations == 0; }

/// Largest difference between loading and unloading, as a share of the largest force.
double path_difference(const PressResults& results) {
  double difference = 0.0, largest = 0.0;
  for (const PressPoint& point : results.loading) largest = std::max(largest, point.force);
  for (std::size_t k = 0; k < results.unloading.size(); ++k) {
    const double up = results.loading[results.loading.size() - 2 - k].force, down = results.unloading[k].force;
    largest = std::max(largest, down);
    difference = std::max(difference, std::abs(down - up));
  }
  return largest > 0.0 ? difference / largest : 0.0;
}

struct Extent {
  double low = INFINITY, high = -INFINITY;
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
  double size() const { return std::max(high - low, 0.0); }
};

}  // namespace

void measure_press(const PressOptions& options, const PressModel& model, const std::function<void(double)>& share,
                   PressResults& results) {
  FURROW_ASSERT(options.at.empty() || options.at.size() == static_cast<std::size_t>(options.points), options.at.size(),
                options.points);
  const int total = (options.unload ? 2 : 1) * options.points;
  const auto at = [&](int k) {
    share(static_cast<double>(k) / total);
    const int step = k <= options.points ? k : 2 * options.points - k;
    const bool equal = options.at.empty() || step == 0;
    return model.press(equal ? options.deflection * step / options.points : options.at[step - 1]);
  };
  bool reached = false;
  const auto look = [&](const PressPoint& point) {
    results.at_load = point;
    results.footprint = model.footprint();
  };
  try {
    results.loading.push_back(at(0));
    if (model.unpressed) model.unpressed();
    for (int k = 1; k <= options.points; ++k) {
      const PressPoint before = results.loading.back();
      const PressPoint& now = results.loading.emplace_back(at(k));
      if (reached) continue;
      reached = before.force < options.load && now.force >= options.load;
      look(reached ? find_load(model.press, before, now, options.load) : now);
      if (model.stiffness && (reached || k == options.points)) results.stiffness = model.stiffness();
    }
    for (int k = options.points + 1; k <= total; ++k) results.unloading.push_back(at(k));
  } catch (const Error& error) {
    if (error.code() != ExitCode::physics || results.loading.empty()) throw;
    results.ended = fmt::format("{}; up to {:.4g} m it was found: see --deflection", error.what(),
                                results.loading.back().deflection);
    if (!options.partial || results.footprint.empty()) throw physics_error(results.ended);
  }
}

void require_no_camber(const PressOptions& options, const char* name) {
  if (options.obstacle.camber == 0.0) return;
  throw input_error(
      options.camber_from, options.camber_key,
      fmt::format("is {:g} rad, expected 0: a {} is alike across its width, so that camber would press no "
                  "side of it more than the other",
                  options.obstacle.camber, name));
}

std::string base_missed(const PressOptions& options, const char* name) {
  const PressObstacle& o = options.obstacle;
  if (!o.profile.empty() || o.height == 0.0 || options.deflection <= o.height) return "";
  return fmt::format(
      "beyond a deflection of {:g} m, the cleat's height, the tire would also touch the ground beside the cleat, which "
      "a {} does not see: forces are too small there",
      o.height, name);
}

std::string press_caution(const PressResults& results) {
  if (!results.base_missed.empty()) return results.base_missed;
  const double difference = path_difference(results);
  const std::string end =
      difference > kOnePath
          ? fmt::format("loading and unloading differ by {:.2g} % of the largest force", 100.0 * difference)
          : std::string("loading and unloading agree");
  if (!stable_unpressed(results))
    return "this tire wrinkles under its pressure: the equilibrium was reached by creep and need not be the "
           "only one; " +
           end;
  const auto failed = [](const PressPoint& point) { return point.failed_factorizations > 0; };
  if (const auto first = std::ranges::find_if(results.loading, failed);
      first != results.loading.end() || std::ranges::any_of(results.unloading, failed))
    return fmt::format(
        "this tire buckles while it is pressed{}: its equilibria were reached by creep and need not be the "
        "only ones; {}",
        first != results.loading.end() ? fmt::format(", first on the way to {:.3g} m", first->deflection) : "", end);
  return difference > kOnePath ? end + ": there is more than one equilibrium" : "";
}

nlohmann::ordered_json press_json(const PressOptions& options, const PressResults& results) {
  nlohmann::ordered_json j;
  const bool profile = !options.obstacle.profile.empty(), cleat = !profile && options.obstacle.height > 0.0;
  j["obstacle"] = profile ? "profile" : (cleat ? "cleat" : "plate");
  if (cleat) {
    j["cleat_height_m"] = options.obstacle.height;
    j["cleat_width_m"] = options.obstacle.width;
    j["cleat_position_m"] = options.obstacle.position;
  }
  const auto if_any = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  j["camber_rad"] = options.obstacle.camber;
  j["pressure_Pa"] = if_any(results.pressure);
  j["mass_kg"] = results.mass.mass;
  j["spin_inertia_kg_m2"] = results.mass.inertia(1, 1);
  j["inflation_growth_m"] = if_any(results.inflation_growth);
  j["runout_m"] = results.runout;
  j["director_runout_rad"] = results.director_runout;
  j["load_N"] = options.load;
  const PressPoint& p = results.at_load;
  const bool reached = std::abs(p.force - options.load) <= kLoadTolerance * options.load;
  const auto if_reached = [&](double value) {
    return reached ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  double tangent = 0.0;
  for (std::size_t k = 1; k < results.loading.size(); ++k)
    if (const PressPoint& a = results.loading[k - 1], &b = results.loading[k]; a.force < p.force && p.force <= b.force)
      tangent = (b.force - a.force) / (b.deflection - a.deflection);
  j["deflection_m"] = if_reached(p.deflection);
  j["axle_height_m"] = if_reached(results.start_height - p.deflection);
  j["secant_stiffness_N_per_m"] = if_reached(p.force / p.deflection);
  j["tangent_stiffness_N_per_m"] = if_reached(tangent);
  const auto vector = [&](const Vec3& v) {
    return reached ? nlohmann::ordered_json({v.x(), v.y(), v.z()}) : nlohmann::ordered_json();
  };
  j["rim_force_N"] = vector(p.rim.force);
  j["rim_moment_Nm"] = vector(p.rim.moment);
  const auto sticking = [&](int k) {
    const double value = results.stiffness ? (*results.stiffness)(k, k) : std::nan("");
    return std::isfinite(value) ? if_reached(value) : nlohmann::ordered_json();
  };
  j["sticking_stiffness"] = {{"longitudinal_N_per_m", sticking(0)},
                             {"lateral_N_per_m", sticking(1)},
                             {"vertical_N_per_m", sticking(2)},
                             {"torsional_Nm_per_rad", sticking(3)}};
  const std::string missing = reached ? results.stiffness_missing : "the load was not reached";
  j["stiffness_missing_because"] = missing.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(missing);
  double residual = 0.0;
  int steps = 0, failed = 0;
  for (const auto* path : {&results.loading, &results.unloading})
    for (const PressPoint& point : *path) {
      residual = std::max(residual, point.residual);
      steps += point.creep_steps, failed += point.failed_factorizations;
    }
  j["ended_because"] = results.ended.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(results.ended);
  j["loading_unloading_difference"] = path_difference(results);
  j["max_residual"] = residual;
  j["creep_steps"] = steps;
  j["failed_factorizations"] = failed;
  j["statically_stable"] = stable_unpressed(results);
  j["stable_while_pressed"] = failed == results.loading.front().failed_factorizations;
  double area = 0.0, force = 0.0, highest = 0.0;
  for (const PressSample& s : results.footprint) highest = std::max(highest, s.pressure);
  Extent length, width;
  for (const PressSample& s : results.footprint) {
    force += s.pressure * s.area;
    if (s.pressure < kEdgePressure * highest) continue;
    area += s.area;
    length.include(s.x), width.include(s.y);
  }
  const auto of_patch = [&](double value) {  // of a model that has a patch
    return results.footprint.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
  };
  j["footprint"] = {
      {"deflection_m", p.deflection},        {"force_N", p.force},
      {"length_m", of_patch(length.size())}, {"width_m", of_patch(results.footprint_width.value_or(width.size()))},
      {"area_m2", of_patch(area)},           {"mean_pressure_Pa", of_patch(area > 0.0 ? force / area : 0.0)},
      {"max_pressure_Pa", of_patch(highest)}};
  return j;
}

void write_press_tables(const std::filesystem::path& folder, const PressResults& results) {
  std::string text = "deflection_m,force_N,residual,unloading,moment_x_Nm,moment_y_Nm\n";
  for (const auto* path : {&results.loading, &results.unloading})
    for (const PressPoint& p : *path)
      fmt::format_to(std::back_inserter(text), "{:.9g},{:.12g},{:.3g},{},{:.9g},{:.9g}\n", p.deflection, p.force,
                     p.residual, path == &results.unloading ? 1 : 0, p.rim.moment.x(), p.rim.moment.y());
  write_whole_file(folder / "press.csv", text);
  text = "x_m,y_m,area_m2,pressure_Pa\n";
  for (const PressSample& s : results.footprint)
    fmt::format_to(std::back_inserter(text), "{:.6g},{:.6g},{:.6g},{:.6g}\n", s.x, s.y, s.area, s.pressure);
  write_whole_file(folder / "footprint.csv", text);
}

}  // namespace furrow::tire
