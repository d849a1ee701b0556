// `furrow bed`: prepares the bed of a scenario, keeps it in the cache and prints its properties.
#include <algorithm>
#include <iostream>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/command_table.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/fields_json.hpp"
#include "terrain/dem/beds/bed_compaction.hpp"
#include "terrain/dem/beds/bed_packing.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/beds/bed_statistics.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::commands {
namespace {

using json = nlohmann::ordered_json;

constexpr double kEven = 0.01;  // solid fraction, by which the layers of an even bed differ from their middle

json bed_json(const scenario::Scenario& s, const terrain::dem::DemOptions& o, const terrain::dem::PreparedBed& prepared,
              const terrain::dem::BedStatistics& bed, std::optional<double> denser, double wall_s) {
  const double mass = o.density * bed.grain_volume;
  const auto number_or_null = [](double value) { return value < 0.0 ? json(nullptr) : json(value); };
  const auto text_or_null = [](const std::string& text) { return text.empty() ? json(nullptr) : json(text); };
  json j;
  j["format_version"] = 1;
  j["version"] = FURROW_VERSION;
  j["scenario"] = s.name;
  j["bed"] = text_or_null(o.bed);
  j["bed_generator"] = o.bed.empty() ? json(o.bed_generator) : json(nullptr);
  j["sides"] = o.sides;
  j["size_distribution"] = o.size_spread > 0.0 ? json(o.size_distribution) : json(nullptr);
  j["size_spread"] = o.size_spread;
  // The found values, if a packing was asked for.
  std::vector<double> laid{o.settling_friction, o.settling_cohesion, o.settling_drag};
  if (prepared.bed.has("bed/packing")) laid = prepared.bed.get<double>("bed/packing", 3);
  j["settling_friction"] = number_or_null(laid[0]);
  j["settling_cohesion_Pa"] = number_or_null(laid[1]);
  j["settling_drag"] = number_or_null(laid[2]);
  j["compaction_pressure_Pa"] = o.compaction_pressure;
  j["terrain"] = fields_json(o, role::bed);  // all keys that affect the bed
  j["grains"] = bed.grains;
  j["radius_m"] = o.radius;  // the median by number
  j["radius_median_by_mass_m"] = bed.median_by_mass;
  j["depth_m"] = bed.depth;
  j["top_m"] = bed.top;
  j["solid_fraction"] = bed.solid_fraction;
  j["solid_fraction_bulk"] = bed.solid_fraction_bulk;
  j["solid_fraction_profile"] = bed.profile;
  j["solid_fraction_asked"] = number_or_null(o.solid_fraction);
  j["solid_fraction_more_at_1_2_g"] = denser ? json(*denser) : json(nullptr);
  j["bulk_density_kg_m3"] = mass / (o.length * o.width * bed.depth);
  j["coordination_number"] = bed.coordination;
  j["contacts"] = bed.pairs;
  j["wall_contacts"] = bed.wall_contacts;
  j["max_overlap_m"] = bed.max_overlap;
  j["settled"] = prepared.settled.settled;
  j["force_residual"] = prepared.settled.force_ratio;
  j["weight_N"] = mass * o.gravity.norm();
  j["floor_force_error"] = prepared.settled.floor_error;
  j["settling_time_s"] = prepared.settled.time;
  j["settling_step_s"] = terrain::dem::settle_step(o);
  j["wall_s"] = wall_s;
  j["threads"] = o.settle_threads;
  j["from_cache"] = prepared.from_cache;
  j["cache_file"] = text_or_null(terrain::dem::bed_is_settled_anew(o) ? prepared.file.string() : "");
  return j;
}

ExitCode make_bed(const scenario::Scenario& scenario) {
  const terrain::dem::DemOptions grains = scenario.grains("only grains make a bed");
  scenario::require_memory(scenario);
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  const double begin = wall_clock();
  const ProgressCall progress = launch::shown_on(display, " while the bed was being prepared");
  terrain::dem::GrainSolver solver(terrain::dem::solver_params(grains));
  const terrain::dem::PreparedBed prepared = terrain::dem::load_bed(solver, grains, progress);
  const terrain::dem::BedStatistics statistics =
      terrain::dem::bed_statistics(terrain::dem::positions_by_id(solver), solver.params().bin, grains.radius, progress);
  std::optional<double> denser;
  if (grains.solid_fraction > 0.0)
    denser = terrain::dem::solid_fraction_under_weight(solver, terrain::dem::level(grains), progress) -
             statistics.solid_fraction_bulk;
  const double wall = wall_clock() - begin;
  display.clear();
  if (!prepared.settled.settled)
    print_warning(scenario.file.string() + ": the bed did not come to rest and is used as it is");
  if (denser && (statistics.solid_fraction_bulk < terrain::dem::kMetastable ||
                 *denser > terrain::dem::packing_tolerance(statistics.solid_fraction_bulk)))
    print_warning(
        fmt::format("{}: the bed is metastable: its solid fraction is {:.4f}, and {:+.4f} under 20 % more gravity",
                    scenario.file.string(), statistics.solid_fraction_bulk, *denser));
  const auto [loosest, densest] = std::ranges::minmax(statistics.profile);
  if (denser && densest - loosest > 2.0 * kEven)
    print_warning(
        fmt::format("{}: the bed is not even: four layers of its middle have solid fractions of {:.4f} to "
                    "{:.4f}, expected a range of at most {:g}; a deeper or wider bed, in grain radii, helps",
                    scenario.file.string(), loosest, densest, 2.0 * kEven));
  std::cout << bed_json(scenario, grains, prepared, statistics, denser, wall).dump(2) << "\n";
  return ExitCode::done;
}

Action bed_options(CLI::App& command, Typed& typed) {
  add_scenario(command, typed);
  return [&typed] { return make_bed(load(typed)); };
}

}  // namespace

Command bed_entry() {
  return {.name = "bed",
          .task = task::test,
          .purpose = "Settle the bed of a scenario, keep it for later runs, and print its statistics as JSON.",
          .options = bed_options,
          .examples = {{"bed drawbar_pull_small.json", "Settle a bed that later runs share."}}};
}

}  // namespace furrow::commands
