#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/segment.hpp"
#include "nodes/output/results.hpp"
#include "nodes/output/statistics.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/hash.hpp"
#include "terrain/rut.hpp"

namespace furrow::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMaxLate =
    0.05;  // of load × speed: energy error of the interface of a run that can be trusted
constexpr std::size_t kMaxLinesLeftOut = 50;  // at the window's beginning, for a whole number of facets

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// The averaging window: rows [first, last], whose means describe the time from `before` to the last row.
struct Window {
  std::span<const SeriesRow> rows;
  SeriesRow before;
  bool whole_facets = false;
  double duration() const { return rows.empty() ? 0.0 : rows.back().time - before.time; }
  template <class Get>
  double mean(Get get) const {
    double sum = 0.0;
    for (const SeriesRow& row : rows) sum += get(row);
    return rows.empty() ? NAN : sum / static_cast<double>(rows.size());
  }
  template <class Get>
  double rate(Get get) const {
    return rows.empty() ? NAN : (get(rows.back()) - get(before)) / duration();
  }
};

/// The window of the scenario, shortened at its beginning to a whole number of tire facets.
Window averaging_window(const SummaryInput& in) {
  FURROW_ASSERT(in_range(in.wheel, in.scenario.tires.size()), in.wheel, in.scenario.tires.size());
  const auto& rows = in.rows;
  std::size_t first = 1;
  while (first < rows.size() && rows[first].time < in.scenario.run.average_from) ++first;
  if (first >= rows.size()) return {};
  const double facet =
      2.0 * std::numbers::pi / scenario::tire_size(in.scenario.tires[in.wheel]).elements_circumference;
  double turned = 0.0, least = INFINITY;
  std::size_t chosen = first;
  bool whole = false;
  for (std::size_t start = rows.size() - 1; start >= first; --start) {
    const double turn = std::abs(rows[start].spin) * (rows[start].time - rows[start - 1].time);
    turned += turn;
    const double off = std::abs(std::remainder(turned, facet));
    if (start >= first + kMaxLinesLeftOut || turned < 0.5 * facet || off >= least) continue;
    least = off;
    chosen = start;
    whole = off <= turn;
  }
  return {rows.subspan(chosen), rows[chosen - 1], whole};
}

Json pull_statistics(const SummaryInput& in, const Window& w, double load) {
  std::vector<double> samples;
  for (const SeriesRow& row : w.rows) samples.push_back(row.drawbar_pull);
  const SeriesStatistics s = statistics(samples);
  const double interval = w.rows.empty() ? NAN : w.duration() / static_cast<double>(w.rows.size());
  const double travel = w.rows.empty() ? 0.0 : std::abs(w.rows.back().position - w.before.position);
  const double turned = w.mean([](const SeriesRow& r) { return std::abs(r.spin); }) * w.duration() *
                        in.cards[1 + in.wheel].tire_radius;
  const double radius = in.cards[1 + in.wheel].tire_radius;
  auto reasons = unsteady_because(s, {load, w.duration(), std::max(travel, turned), radius, w.whole_facets});
  const double late = w.rate([](const SeriesRow& r) { return r.energy_error_abs; });
  const double rolling = load * std::max(travel, turned) / w.duration();
  if (late > kMaxLate * rolling)
    reasons.push_back(fmt::format(
        "contact forces that come one step late feed the tire: {:.3g} W at its interface, {:.0f} % of "
        "load × speed; take a smaller run.step or tire.contact_tangent",
        late, 100.0 * late / rolling));
  return {{"mean", number(s.mean)},
          {"std", number(s.std)},
          {"sem", number(s.sem)},
          {"n_eff", number(s.n_eff)},
          {"drift_N_per_s", number(s.drift / interval)},
          {"steady", reasons.empty()},
          {"unsteady_because", reasons},
          {"from_s", number(w.rows.empty() ? NAN : w.before.time)},
          {"to_s", number(w.rows.empty() ? NAN : w.rows.back().time)}};
}

/// T ω − P v = dissipation in soil and tire + rate of stored energy + what the lag of the interfaces loses.
Json power_balance(const Window& w) {
  const double spindle = w.rate([](const SeriesRow& r) { return r.spindle_work; });
  const double pull = w.rate([](const SeriesRow& r) { return r.pull_work; });
  const double soil = w.rate([](const SeriesRow& r) { return r.soil_dissipation; });
  const double tire = w.rate([](const SeriesRow& r) { return r.tire_dissipation; });
  const double damper = w.rate([](const SeriesRow& r) { return r.damper_dissipation; });
  const double stored = w.rate([](const SeriesRow& r) {
    return r.terrain_kinetic_energy + r.terrain_potential_energy + r.terrain_elastic_energy + r.tire_energy +
           r.carried_energy;
  });
  const double interface = -w.rate([](const SeriesRow& r) { return r.energy_error + r.rim_energy_error; });
  const double residual = spindle - pull - soil - tire - damper - stored - interface;
  return {{"spindle_power_W", number(spindle)},
          {"pull_power_W", number(pull)},
          {"soil_dissipation_W", number(soil)},
          {"tire_dissipation_W", number(tire)},
          {"damper_dissipation_W", number(damper)},
          {"stored_rate_W", number(stored)},
          {"interface_loss_W", number(interface)},
          {"residual_W", number(residual)},
          {"residual_share", number(residual / (spindle - pull))}};
}

/// Means in the tire's axes on the ground, with the standard errors of forces and moments.
Json tire_axes_means(const Window& w) {
  Json json;
  for (const auto& [name, vector] :
       {std::pair{"force_N", &SeriesRow::iso_force}, std::pair{"moment_Nm", &SeriesRow::iso_moment}}) {
    Json means = Json::array(), errors = Json::array();
    for (int i = 0; i < 3; ++i) {
      std::vector<double> samples;
      for (const SeriesRow& row : w.rows) samples.push_back((row.*vector)[i]);
      const SeriesStatistics s = statistics(samples);
      means.push_back(number(s.mean));
      errors.push_back(number(s.sem));
    }
    json[name] = means;
    json[std::string(name).insert(std::string(name).find('_'), "_sem")] = errors;
  }
  json["slip_angle_rad"] = number(w.mean([](const SeriesRow& r) { return r.slip_angle; }));
  json["camber_angle_rad"] = number(w.mean([](const SeriesRow& r) { return r.camber_angle; }));
  json["loaded_radius_m"] = number(w.mean([](const SeriesRow& r) { return r.loaded_radius; }));
  return json;
}

void add_rut(const SummaryInput& in, Json& json) {
  const FinalReport& terrain = in.reports.back();
  terrain::Rut rut;
  if (!in.rows.empty()) {
    terrain::RutOptions options;
    options.direction = in.scenario.rigs[in.wheel].travel_sign;
    options.lateral = in.scenario.rigs[in.wheel].lateral;
    options.axle = options.direction * in.rows.back().position;
    options.start = options.direction * in.rows.front().position;
    options.tread_width = in.cards[1 + in.wheel].tire_width;
    rut = terrain::measure_rut(terrain.height_before, terrain.height_after, options);
  }
  json["rut_depth_m"] = number(rut.measured ? rut.depth : NAN);
  json["rut_width_m"] = number(rut.measured ? rut.width : NAN);
}

void add_mobility(const SummaryInput& in, const Window& w, Json& json) {
  const double load = in.carried_mass * kStandardGravity, radius = in.cards[1 + in.wheel].tire_radius;
  json["drawbar_pull_N"] = pull_statistics(in, w, load);
  const auto mean = [&](auto get) { return w.mean(get); };
  const double pull = mean([](const SeriesRow& r) { return r.drawbar_pull; });
  const double speed = mean([](const SeriesRow& r) { return r.speed; });
  const double spin = mean([](const SeriesRow& r) { return r.spin; });
  const double torque = mean([](const SeriesRow& r) { return r.drive_torque; });
  const double force_z = mean([](const SeriesRow& r) { return r.force.z(); });
  const double lowest = mean([](const SeriesRow& r) { return r.lowest_point; });
  const double axle = mean([](const SeriesRow& r) { return r.axle_height; });
  json["drawbar_coefficient"] = number(pull / load);
  json["sinkage_m"] = number(mean([](const SeriesRow& r) { return r.sinkage; }));
  json["sinkage_kinematic_m"] = number(mean([](const SeriesRow& r) { return r.sinkage_kinematic; }));
  add_rut(in, json);
  json["tire_deflection_m"] = number(radius - (axle - lowest));
  json["effective_rolling_radius_m"] =
      number(spin != 0.0 ? mean([](const SeriesRow& r) { return r.effective_rolling_radius * r.spin; }) / spin
                         : NAN);
  json["bed_clearance_m"] = number(lowest - in.setup.floor_height);
  json["vertical_load_N"] = number(load);
  json["net_terrain_force_N"] = {number(mean([](const SeriesRow& r) { return r.force.x(); })),
                                 number(mean([](const SeriesRow& r) { return r.force.y(); })),
                                 number(force_z)};
  const double momentum_rate = w.rate([](const SeriesRow& r) { return r.vertical_momentum; });
  json["vertical_balance_residual"] = number((force_z - load - momentum_rate) / load);
  json["terrain_resistance_N"] = number(-mean([](const SeriesRow& r) { return r.normal_force_travel; }));
  json["tractive_effort_N"] = number(mean([](const SeriesRow& r) { return r.tractive_effort; }));
  json["drive_torque_Nm"] = number(torque);
  json["lateral_force_N"] = number(mean([](const SeriesRow& r) { return r.lateral_force; }));
  json["aligning_moment_Nm"] = number(mean([](const SeriesRow& r) { return r.aligning_moment; }));
  json["tractive_efficiency"] = number(pull * speed / (torque * spin));
  json["motion_resistance_coefficient"] = number((torque / radius - pull) / load);
  json["iso_w"] = tire_axes_means(w);
}

Json rank_table(const SummaryInput& in) {
  Json ranks = Json::array();
  for (std::size_t i = 0; i < in.reports.size(); ++i) {
    const FinalReport& r = in.reports[i];
    ranks.push_back({{"rank", i},
                     {"node", to_string(r.self)},
                     {"kind", in.cards[i].node_kind},
                     {"threads", r.threads},
                     {"cpu_s", r.cpu_s},
                     {"compute_s", r.compute_s},
                     {"wait_s", r.wait_s},
                     {"busy_share", number(r.compute_s / (r.compute_s + r.wait_s))}});
  }
  return ranks;
}

void add_accounts(const SummaryInput& in, const Window& w, Json& json) {
  const SeriesRow& end = in.builder.now();
  const double sent = in.builder.impulse_sent_abs();
  json["power_balance"] = power_balance(w);
  json["interface_energy_error_J"] = number(end.energy_error);
  json["interface_energy_error_abs_J"] = number(end.energy_error_abs);
  json["rim_energy_error_J"] = number(end.rim_energy_error);
  json["interface_work_J"] = number(end.spindle_work);
  json["momentum_residual"] = number(
      sent > 0.0
          ? (in.builder.impulse_sent_arrived() - (end.impulse_received - in.tire.impulse_ahead)).norm() / sent
          : 0.0);
  if (in.tire.contact_tangent) {
    json["contact_ledger_Ns"] = number(in.tire.ledger);
    json["contact_ledger_largest_Ns"] = number(in.tire.ledger_largest);
  }
  json["transfer_force_residual"] = number(end.transfer_force_residual);
  json["transfer_moment_residual"] = number(end.transfer_moment_residual);
}

void add_cost(const SummaryInput& in, Json& json) {
  const SeriesRow& end = in.builder.now();
  const double steps = std::max(1.0, std::round(end.time / in.scenario.run.step));
  json["simulated_s"] = end.time;
  double wall = 0.0;
  for (const checkpoint::Segment& segment : in.segments) wall += segment.wall_s;
  json["wall_s"] = wall;
  json["settle_wall_s"] = in.setup.settle_wall_s;
  json["wall_s_per_simulated_s"] = number(wall / end.time);
  json["ranks"] = rank_table(in);
  json["segments"] = checkpoint::segments_json(in.segments);
  json["grains"] = in.setup.grains;
  double contacts = 0.0, active = 0.0;
  for (const SeriesRow& row : in.rows) {
    contacts += row.contacts_terrain;
    active += row.active_share;
  }
  const auto lines = static_cast<double>(in.rows.size());
  json["contacts_mean"] = number(contacts / lines);
  json["active_share_mean"] = number(active / lines);
  json["tire_coordinates"] = in.cards[1 + in.wheel].size;
  json["newton_iterations_mean"] = number(end.newton_iterations / steps);
  json["factorizations"] = end.factorizations;
  json["compiler"] = "g++ " __VERSION__;
  json["cpu"] = checkpoint::cpu_model();
}

}  // namespace

std::string summary_text(const SummaryInput& in) {
  FURROW_ASSERT(in.reports.size() == in.cards.size(), in.reports.size(), in.cards.size());
  FURROW_ASSERT(in_range(in.wheel, in.scenario.rigs.size()), in.wheel, in.scenario.rigs.size());
  Hash state;
  for (const FinalReport& report : in.reports) state.add(&report.state_hash, sizeof report.state_hash);
  Json json;
  json["format_version"] = 1;
  json["version"] = FURROW_VERSION;
  json["scenario"] = in.scenario.name;
  json["scenario_digest"] = in.scenario.digest;
  json["state_hash"] = state.hex();
  json["terrain_engine"] = in.scenario.terrain.engine;
  json["law"] = in.scenario.terrain.law;
  json["slip"] = in.scenario.rigs[in.wheel].slip;
  json["travel_sign"] = in.scenario.rigs[in.wheel].travel_sign;
  json["wheel"] = in.wheel;
  json["lateral_m"] = in.scenario.rigs[in.wheel].lateral;
  json["tire_radius_m"] = in.cards[1 + in.wheel].tire_radius;
  json["tread_width_m"] = in.cards[1 + in.wheel].tire_width;
  json["surface_height_m"] = number(in.setup.mean_height.at(in.wheel));
  const Window window = averaging_window(in);
  add_mobility(in, window, json);
  add_accounts(in, window, json);
  add_cost(in, json);
  return json.dump(2) + "\n";
}

}  // namespace furrow::output
