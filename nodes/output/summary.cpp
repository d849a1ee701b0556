#include <algorithm>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/checkpoint/segment.hpp"
#include "nodes/output/accounts_json.hpp"
#include "nodes/output/averaging_window.hpp"
#include "nodes/output/lag_json.hpp"
#include "nodes/output/regressions.hpp"
#include "nodes/output/results.hpp"
#include "nodes/output/steadiness.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/core/rank_group.hpp"
#include "protocol/files/json_number.hpp"
#include "protocol/files/program_id.hpp"
#include "rigs/reported_slip.hpp"
#include "terrain/rut.hpp"

namespace furrow::output {
namespace {

#ifdef __clang__
constexpr const char* kCompiler = __VERSION__;  // names clang itself
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

using Json = nlohmann::ordered_json;

constexpr double kAlongX = 0.1;             // largest sine of the heading to x where a rut is measured
constexpr double kLeastWindow = 0.1;        // of the planned averaging window, that a run must have reached
constexpr char kPull[] = "drawbar_pull_N";  // the rig's, if it has one
constexpr char kDistance[] = "distance_m";  // of a whole vehicle, if the rig is one

struct WheelInput {
  const SummaryInput& run;
  int wheel = 0;
  const Table& table;
  WheelRows rows;
  const WheelEnd& end;
  const NodeCard& card() const { return run.cards[1 + wheel]; }
};

/// Settlement of tire and ground under the load, m; of grousers, that of their tips.
double settlement(const WheelInput& in, const Window& w) {
  const double tips = in.run.scenario.tires[in.wheel]->describe().grouser_height;
  const auto given = [&](const WheelRow& r) {
    return r.sinkage + in.card().tire_radius - (r.axle_height - r.lowest_point);
  };
  return w.mean(given) + tips;
}

Json pull_statistics(const WheelInput& in, const Window& w, const SeriesStatistics& sinkage) {
  const SeriesStatistics s = statistics(w.samples(kPull));
  const double load = in.end.load;
  const double interval = w.rows.empty() ? NAN : w.duration() / static_cast<double>(w.rows.size());
  const double travel = w.rows.empty() ? 0.0 : std::abs(w.rows.back().position - w.before.position);
  const double turned =
      w.mean([](const WheelRow& r) { return std::abs(r.spin); }) * w.duration() * in.card().tire_radius;
  const double radius = in.card().tire_radius;
  const double given = settlement(in, w), bounce = bounce_period(given, kStandardGravity);
  auto reasons = unsteady_because(
      s, sinkage, {load, given, bounce, w.duration(), std::max(travel, turned), radius, w.whole_facets});
  if (in.run.failure) reasons.emplace_back("the run failed before its end");
  return {{"mean", json_number(s.mean)},
          {"std", json_number(s.std)},
          {"sem", json_number(s.sem)},
          {"n_eff", json_number(s.n_eff)},
          {"drift_N_per_s", json_number(s.slope / interval)},
          {"drift_t", json_number(s.drift.t)},
          {"halves_differ_N", json_number(s.drift.change)},
          {"steady", reasons.empty()},
          {"unsteady_because", reasons},
          {"bounce_period_s", json_number(bounce)},
          {"from_s", json_number(w.rows.empty() ? NAN : w.before.time)},
          {"to_s", json_number(w.rows.empty() ? NAN : w.rows.back().time)}};
}

/// Means in the tire's axes on the ground, with the standard errors of forces and moments.
Json tire_axes_means(const Window& w) {
  Json json;
  for (const auto& [name, vector] :
       {std::pair{"force_N", &WheelRow::iso_force}, std::pair{"moment_Nm", &WheelRow::iso_moment}}) {
    Json means = Json::array(), errors = Json::array();
    for (int i = 0; i < 3; ++i) {
      const SeriesStatistics s =
          statistics(w.samples_by([i, of = vector](const WheelRow& row) { return (row.*of)[i]; }));
      means.push_back(json_number(s.mean));
      errors.push_back(json_number(s.sem));
    }
    json[name] = means;
    json[std::string(name).insert(std::string(name).find('_'), "_sem")] = errors;
  }
  json["slip_angle_rad"] = json_number(w.mean(&WheelRow::slip_angle));
  json["camber_angle_rad"] = json_number(w.mean(&WheelRow::camber_angle));
  json["loaded_radius_m"] = json_number(w.mean(&WheelRow::loaded_radius));
  return json;
}

void add_rut(const WheelInput& in, Json& json) {
  terrain::Rut rut;
  if (in.rows.empty()) {
    rut.missing = "the series has no lines";
  } else if (in.run.end.reports.empty()) {
    rut.missing = "the run failed before its end";
  } else if (!(std::abs(in.end.heading.y()) < kAlongX)) {
    rut.missing = "the wheel moves at an angle to x, and ruts along x are measured";
  } else {
    const FinalReport& terrain = in.run.end.reports[scenario::terrain_rank(in.run.scenario)];
    terrain::RutOptions options;
    options.direction = in.end.heading.x() < 0.0 ? -1.0 : 1.0;
    options.lateral = in.end.centre.y();
    options.axle = in.end.centre.x();
    options.start = options.axle - options.direction * (in.rows.back().position - in.rows.front().position);
    options.radius = in.card().tire_radius;
    options.tread_width = in.card().tire_width;
    rut = terrain::measure_rut(terrain.height_before, terrain.height_after, options);
  }
  const SeriesStatistics along = statistics(rut.along);
  json["rut_depth_m"] = json_number(rut.measured ? rut.depth : NAN);
  json["rut_depth_sem_m"] = json_number(rut.measured ? along.sem : NAN);
  json["rut_depth_n_eff"] = json_number(rut.measured ? along.n_eff : NAN);
  json["rut_width_m"] = json_number(rut.measured ? rut.width : NAN);
  json["rut_missing_because"] = rut.missing.empty() ? Json(nullptr) : Json(rut.missing);
}

/// Adds the slip counted from its other zeros, and the results of regressions for this wheel.
void add_regressions(const WheelInput& in, const Window& w, double deflection, Json& json) {
  const tire::TireDescription tire = in.run.scenario.tires[in.wheel]->describe();
  const terrain::TerrainDescription terrain = in.run.scenario.terrain->describe();
  const double radius = in.card().tire_radius, bent = tire.deflects ? std::max(deflection, 0.0) : 0.0;
  const double speed = w.mean(&WheelRow::speed), spin = w.mean(&WheelRow::spin);
  const double rolling = free_rolling_radius(radius, bent), hard = no_pull_radius(radius, bent);
  const SlipZeros slip{rigs::reported_slip(spin * rolling, speed), rigs::reported_slip(spin * hard, speed)};
  json["free_rolling_radius_m"] = json_number(rolling);
  json["slip_of_free_rolling"] = json_number(slip.free_rolling);
  json["no_pull_radius_m"] = json_number(hard);
  json["slip_of_no_pull"] = json_number(slip.no_pull);
  json["regressions"] = regressions_json({.cone_index = terrain.cone_index.value_or(NAN),
                                          .diameter = 2.0 * radius,
                                          .width = tire.width,
                                          .section_height = tire.section_height > 0.0 ? tire.section_height : NAN,
                                          .deflection = bent,
                                          .load = in.end.load,
                                          .slip = NAN},
                                         slip, terrain.cohesive);
}

void add_mobility(const WheelInput& in, const Window& w, Json& json) {
  const double load = in.end.load, radius = in.card().tire_radius;
  const SeriesStatistics sinkage = statistics(w.samples_by(&WheelRow::sinkage));
  if (in.table.find(kPull)) json[kPull] = pull_statistics(in, w, sinkage);
  const auto mean = [&](auto get) { return w.mean(get); };
  const double pull = w.mean_of(kPull);
  const double speed = mean(&WheelRow::speed);
  const double spin = mean(&WheelRow::spin);
  const double torque = mean(&WheelRow::drive_torque);
  const double force_z = mean([](const WheelRow& r) { return r.force.z(); });
  const double lowest = mean(&WheelRow::lowest_point);
  const double axle = mean(&WheelRow::axle_height);
  json["drawbar_coefficient"] = json_number(pull / load);
  json["sinkage_m"] = json_number(mean(&WheelRow::sinkage));
  json["sinkage_sem_m"] = json_number(sinkage.sem);
  json["sinkage_n_eff"] = json_number(sinkage.n_eff);
  json["sinkage_drift_m_per_s"] = json_number(sinkage.slope * static_cast<double>(w.rows.size()) / w.duration());
  json["sinkage_drift_t"] = json_number(sinkage.drift.t);
  json["sinkage_kinematic_m"] = json_number(mean(&WheelRow::sinkage_kinematic));
  add_rut(in, json);
  json["tire_deflection_m"] = json_number(radius - (axle - lowest));
  add_regressions(in, w, radius - (axle - lowest), json);
  json["effective_rolling_radius_m"] = json_number(
      spin != 0.0 ? mean([](const WheelRow& r) { return r.effective_rolling_radius * r.spin; }) / spin : NAN);
  json["bed_clearance_m"] = json_number(lowest - in.run.setup.floor_height);
  json["vertical_load_N"] = json_number(load);
  json["net_terrain_force_N"] = {json_number(mean([](const WheelRow& r) { return r.force.x(); })),
                                 json_number(mean([](const WheelRow& r) { return r.force.y(); })),
                                 json_number(force_z)};
  const double momentum_rate = w.rate(&WheelRow::vertical_momentum);
  json["vertical_balance_residual"] = json_number((force_z - load - momentum_rate) / load);
  json["terrain_resistance_N"] = json_number(-mean(&WheelRow::normal_force_travel));
  json["tractive_effort_N"] = json_number(mean(&WheelRow::tractive_effort));
  json["drive_torque_Nm"] = json_number(torque);
  json["lateral_force_N"] = json_number(mean(&WheelRow::lateral_force));
  json["aligning_moment_Nm"] = json_number(mean(&WheelRow::aligning_moment));
  const double power = torque * spin;
  json["tractive_efficiency"] = json_number(power > 0.0 ? pull * speed / power : NAN);
  json["motion_resistance_coefficient"] = json_number((torque / radius - pull) / load);
  json["iso_w"] = tire_axes_means(w);
}

/// Excess of the terrain rank with most grains over the mean of all, as a share of that mean; NaN if unknown.
double imbalance(const SummaryInput& in, std::int64_t FinalReport::*grains) {
  std::vector<std::int64_t> counts;
  for (const FinalReport& r : in.end.reports)
    if (r.self.role == Role::terrain) counts.push_back(r.*grains);
  counts.resize(std::max(in.scenario.terrain_ranks, 1));
  const bool known = std::any_of(counts.begin(), counts.end(), [](std::int64_t n) { return n > 0; });
  return known ? furrow::imbalance(counts) : NAN;
}

Json ranks_json(const SummaryInput& in) {
  Json ranks = Json::array();
  for (std::size_t i = 0; i < in.end.reports.size(); ++i) {
    const FinalReport& r = in.end.reports[i];
    const NodeCard& card = in.cards[i];
    const double busy = r.compute_s + r.communicate_s;
    ranks.push_back({{"rank", i},
                     {"node", to_string(r.self, in.scenario.terrain_ranks)},
                     {"kind", card.node_kind},
                     {"threads", r.threads},
                     {"size", r.self.role == Role::terrain ? r.grains : card.size},  // grains, unknowns of a tire
                     {"step_s", in.scenario.run.step / std::max(1, card.substeps)},
                     {"cpu_s", r.cpu_s},
                     {"compute_s", r.compute_s},
                     {"communicate_s", r.communicate_s},
                     {"wait_s", r.wait_s},
                     {"busy_share", json_number(busy / (busy + r.wait_s))}});
  }
  return ranks;
}

/// Compares sent and received values of the same forces: this checks the transport, not the physics.
void add_plumbing(const WheelInput& in, Json& json) {
  const SeriesBuilder& series = in.end.series;
  const SpindleReport& tire = in.end.tire;
  const WheelRow end = series.now();
  const double sent = series.impulse_sent_abs();
  json["interface_energy_error_J"] = json_number(end.energy_error);
  json["interface_energy_error_abs_J"] = json_number(end.energy_error_abs);
  json["rim_energy_error_J"] = json_number(end.rim_energy_error);
  json["interface_work_J"] = json_number(tire.terrain_work);  // Σ f·Δx, on the tire by the terrain
  json["spindle_work_J"] = json_number(end.spindle_work);
  json["momentum_residual"] = json_number(
      sent > 0.0 ? (series.impulse_sent_arrived() - (end.impulse_received - tire.impulse_ahead)).norm() / sent : 0.0);
  if (tire.contact_tangent) {
    json["contact_ledger_Ns"] = json_number(tire.ledger);
    json["contact_ledger_largest_Ns"] = json_number(tire.ledger_largest);
  }
  json["transfer_force_residual"] = json_number(end.transfer_force_residual);
  json["transfer_moment_residual"] = json_number(end.transfer_moment_residual);
}

/// Figures of a table from line `first` on, by the names of its columns: the mean of the lines, or the last value of a
/// column that counts since the start of the run. Thus every column reaches the summary, including those of rigs.
Json column_figures(const Table& table, std::size_t first) {
  Json json;
  for (const Column& column : table.columns) {
    if (std::string_view(column.name) == "time_s") continue;
    const std::vector<double> values = table.column(column.name);
    const bool since_start = column.kind == ColumnKind::cumulative || column.kind == ColumnKind::largest;
    double sum = 0.0;
    for (std::size_t i = first; i < values.size(); ++i) sum += values[i];
    const bool any = first < values.size();
    json[column.name] = json_number(!any          ? NAN
                                    : since_start ? values.back()
                                                  : sum / static_cast<double>(values.size() - first));
  }
  return json;
}

/// Start of the averaging window. If a run ended so early that little of the window is left, the window begins at the
/// same share of the run.
double average_from(const SummaryInput& in) {
  const scenario::RunOptions& run = in.scenario.run;
  const bool enough = in.end.time - run.average_from >= kLeastWindow * (run.end - run.average_from);
  return in.failure || enough ? run.average_from : run.average_from * in.end.time / run.end;
}

void add_findings(const rigs::RigFindings& findings, Json& json) {
  for (const rigs::RigEvent& event : findings.events) {
    json["events"].push_back({{"event", event.what}, {"from_s", event.from}, {"to_s", json_number(event.to)}});
    if (event.wheel >= 0) json["events"].back()["wheel"] = event.wheel;
  }
  for (const auto& [name, value] : findings.figures) json["figures"][name] = json_number(value);
}

Json wheel_summary(const WheelInput& in) {
  Json json;
  const rigs::WheelDescription wheel = scenario::describe_rig(in.run.scenario).wheels[in.wheel];
  json["slip"] = wheel.slip ? Json(*wheel.slip) : Json(nullptr);
  json["travel_sign"] = wheel.travel_sign;
  json["wheel"] = in.wheel;
  if (!wheel.name.empty()) json["name"] = wheel.name;
  json["lateral_m"] = wheel.lateral;
  json["tire_radius_m"] = in.card().tire_radius;
  json["tread_width_m"] = in.card().tire_width;
  json["surface_height_m"] = json_number(in.run.setup.mean_height.at(in.wheel));
  const Window window =
      averaging_window(in.table, average_from(in.run), in.run.scenario.tires[in.wheel]->describe().facets);
  add_mobility(in, window, json);
  add_plumbing(in, json);
  const WheelRow end = in.end.series.now();
  const double steps = std::max(1.0, std::round(end.time / in.run.scenario.run.step));
  json["tire_coordinates"] = in.card().size;
  json["newton_iterations_mean"] = json_number(end.newton_iterations / steps);
  json["factorizations"] = end.factorizations;
  json["columns"] = column_figures(in.table, window.rows.empty() ? in.rows.size() : window.first);
  return json;
}

/// @param rows of any wheel: the terrain's columns are the same in all
void add_cost(const SummaryInput& in, const WheelRows& rows, Json& json) {
  const double time = in.end.time;
  json["simulated_s"] = time;
  double wall = 0.0;
  for (const checkpoint::Segment& segment : in.segments) wall += segment.wall_s;
  json["wall_s"] = wall;
  json["settle_wall_s"] = in.setup.settle_wall_s;
  json["wall_s_per_simulated_s"] = json_number(wall / time);
  if (!in.end.reports.empty()) json["ranks"] = ranks_json(in);
  json["segments"] = checkpoint::segments_json(in.segments);
  json["grains"] = in.setup.grains;
  double contacts = 0.0, active = 0.0;
  for (const WheelRow& row : rows) {
    contacts += row.contacts_terrain;
    active += row.active_share;
  }
  const auto lines = static_cast<double>(rows.size());
  json["contacts_mean"] = json_number(contacts / lines);
  json["active_share_mean"] = json_number(active / lines);
  json["substeps_added"] = in.end.terrain.substeps_added;
  json["substeps_refined_share"] = json_number(in.end.terrain.refined_time / time);
  json["substeps_most_parts"] = in.end.terrain.most_parts;
  json["compiler"] = kCompiler;
  json["cpu"] = cpu_model();
}

/// Adds the main figures of a vehicle; all of its columns are in `subjects`. @param gravity against the ground, m/s²
void add_vehicle(std::span<const Table> tables, double gravity, Json& json) {
  const auto table =
      std::find_if(tables.begin(), tables.end(), [](const Table& t) { return t.find(kDistance).has_value(); });
  if (table == tables.end()) return;
  const Json& figures = json["subjects"][table->subject];
  double weight = 0.0, pitch = 0.0;
  for (const Json& wheel : json["wheels"])
    if (wheel["vertical_load_N"].is_number()) weight += wheel["vertical_load_N"].get<double>();
  for (const double angle : table->column("pitch_rad")) pitch = std::max(pitch, std::abs(angle));
  Json energy = {{"engine", figures["drive_work_J"]}};
  for (const char* heat : {"converter", "clutch", "shift", "brake", "shock", "lowering"})
    energy[heat] = figures[std::string(heat) + "_heat_J"];
  energy["residual"] = json.contains("accounts") ? json["accounts"]["energy"]["residual_of"]["rig"] : Json();
  json[table->subject] = {{"mass_kg", json_number(weight / gravity)},
                          {kDistance, figures[kDistance]},
                          {"mean_speed_m_s", figures["speed_m_s"]},
                          {"max_pitch_rad", json_number(pitch)},
                          {"energy_J", energy}};
}

}  // namespace

std::string summary_text(const SummaryInput& in) {
  FURROW_ASSERT(in.failure || in.end.reports.size() == in.cards.size(), in.end.reports.size(), in.cards.size());
  FURROW_ASSERT(in.tables.size() >= in.end.wheels.size(), in.tables.size(), in.end.wheels.size());
  FURROW_ASSERT(in.failure || !in.end.wheels.empty(), in.end.wheels.size());
  Hash state;
  for (const FinalReport& report : in.end.reports) state.add(&report.state_hash, sizeof report.state_hash);
  Json json;
  json["format_version"] = 1;
  json["version"] = FURROW_VERSION;
  json["scenario"] = in.scenario.name;
  json["scenario_digest"] = in.scenario.digest;
  if (in.failure)
    json["failed"] = {
        {"exit_code", static_cast<int>(in.failure->code)}, {"error", in.failure->text}, {"time_s", in.end.time}};
  else
    json["state_hash"] = state.hex();
  if (!in.failure) json["end_reason"] = to_string(in.end.reason);
  json["end_time_s"] = in.end.time;
  json["average_from_s"] = average_from(in);
  const terrain::TerrainDescription terrain = in.scenario.terrain->describe();
  json["terrain_engine"] = terrain.engine;
  if (in.scenario.terrain_ranks > 1) {
    json["terrain_ranks"] = in.scenario.terrain_ranks;
    if (!in.end.reports.empty())
      json["terrain_imbalance"] = {{"begin", json_number(imbalance(in, &FinalReport::grains_begin))},
                                   {"end", json_number(imbalance(in, &FinalReport::grains))}};
  }
  if (!terrain.law.empty()) json["law"] = terrain.law;
  Json wheels = Json::array();
  for (std::size_t k = 0; k < in.end.wheels.size(); ++k)
    wheels.push_back(wheel_summary({in, static_cast<int>(k), in.tables[k], WheelRows(in.tables[k]), in.end.wheels[k]}));
  if (wheels.size() == 1) json.update(wheels.front());
  if (!in.end.wheels.empty()) json["accounts"] = accounts_json(in.end.accounts, in.tables.back(), average_from(in));
  if (!in.end.wheels.empty()) json["interface"] = lag_json(in, average_from(in));
  add_cost(in, WheelRows(in.tables.front()), json);
  json["wheels"] = wheels;
  for (const Table& table : in.tables.subspan(std::min(in.scenario.tires.size(), in.tables.size()))) {
    if (table.subject == kAccountsTable) continue;
    const std::vector<double> times = table.column("time_s");
    std::size_t first = 1;
    while (first < times.size() && times[first] < average_from(in)) ++first;
    json["subjects"][table.subject] = column_figures(table, first);
  }
  add_vehicle(in.tables, -in.scenario.rig->gravity().z(), json);
  add_findings(in.end.findings, json);
  return json.dump(2) + "\n";
}

}  // namespace furrow::output
