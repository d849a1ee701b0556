#include "terrain/dem/beds/bed_preparation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_compaction.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_packing.hpp"
#include "terrain/dem/beds/bed_statistics.hpp"
#include "terrain/dem/beds/bed_tiling.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr const char* kReached = "bed/solid_fraction";  // of a bed with a prescribed fraction
constexpr int kMostPackings = 4;                        // of a bed with a prescribed solid fraction
constexpr double kSmallBed = 2.0;                       // in samples: a smaller bed is its own sample

std::vector<double> geometry(const DemOptions& o) { return {o.radius, o.density, o.length, o.width}; }

const char* sides(bool periodic) { return periodic ? "periodic" : "walls"; }

/// Checks that a bed from a file has this bin, these grains and this law.
void check_bed(const Archive& bed, const DemOptions& o) {
  if (bed.get_int("surfaces/count") != 0) throw io_error(o.bed, "holds a tire besides its grains, expected a bed");
  const auto& made = bed.get<double>("bed/geometry", 4);
  constexpr const char* kKey[] = {"radius", "density", "length", "width"};
  const std::vector<double> wanted = geometry(o);
  for (int k = 0; k < 4; ++k)
    if (made[k] != wanted[k])
      throw input_error(o.scenario, std::string("terrain.") + kKey[k],
                        fmt::format("is {} but the bed '{}' was made with {}", wanted[k], o.bed, made[k]));
  const double spread = bed.get_double("bed/size_spread");
  if (spread != o.size_spread)
    throw input_error(o.scenario, "terrain.size_spread",
                      fmt::format("is {} but the bed '{}' was made with {}", o.size_spread, o.bed, spread));
  const bool periodic = bed.get_int("bed/periodic_sides") != 0;
  if (periodic != o.periodic_y())
    throw input_error(
        o.scenario, "terrain.sides",
        fmt::format("is '{}' but the bed '{}' was made with '{}'", sides(o.periodic_y()), o.bed, sides(periodic)));
  const auto& law = bed.get<std::uint8_t>("bed/law");
  if (std::string(law.begin(), law.end()) != o.law)
    throw input_error(
        o.scenario, "terrain.law",
        fmt::format("is {} but the bed '{}' was settled with {}", o.law, o.bed, std::string(law.begin(), law.end())));
  if ((o.rolling_friction > 0.0) && bed.get<double>("pairs/rolling").empty() && bed.get_int("count") > 0 &&
      has_history(law_from(o.law)))
    throw input_error(o.scenario, "terrain.rolling_friction",
                      fmt::format("is {} but the bed '{}' was settled without", o.rolling_friction, o.bed));
}

bool from_cache(const std::filesystem::path& file, const DemOptions& options, Archive& bed,
                const ProgressCall& progress) {
  if (file.empty()) return false;
  try {
    std::string digest;
    bed = read_bed(file, progress, &digest);
    check_bed(bed, options);
    return digest.empty() || digest == bed_digest(options);
  } catch (const Error& error) {
    if (error.code() != ExitCode::io && error.code() != ExitCode::bad_input) throw;
    return false;  // absent or damaged: the bed is made again
  }
}

/// The options of the grains while they fall. Smoother ones come to rest more densely packed, rougher ones more loosely
/// [Agnolin & Roux 2007, doi:10.1103/PhysRevE.76.061302].
DemOptions falling(DemOptions o) {
  if (o.settling_cohesion >= 0.0) o.cohesion = o.settling_cohesion;
  if (o.settling_friction < 0.0) return o;
  if (o.friction > 0.0) o.rolling_friction *= o.settling_friction / o.friction;
  o.friction = o.settling_friction;
  return o;
}

ProgressCall named(const char* part, const ProgressCall& progress) {
  if (!progress) return {};
  return [part, &progress](const std::string& what, double share) {
    progress(what.starts_with(kWarning) ? what : part + what, share);
  };
}

/// Copies of a settled piece, joined and settled again.
Archive tiled_bed(const DemOptions& options, const ProgressCall& progress, SettleResult& result) {
  const DemOptions of_piece = piece_of(options);
  GrainSolver solver(settling_params(of_piece));
  const PreparedBed piece = load_bed(solver, of_piece, named("a piece of the bed: ", progress));
  const std::vector<Quad> positions = tiled_positions(positions_by_id(solver), options, progress);
  // Only grains near a joint or a wall have far to move; the others may sleep.
  SolverParams params = settling_params(options);
  params.activity = has_history(params.law);
  solver = GrainSolver(params);
  solver.place(positions);
  result = settle(solver, options, named("joints of the bed: ", progress), kMaxSettleTime, kJointDrag);
  result.time += piece.settled.time;
  result.steps += piece.settled.steps;
  return bed_archive(solver, options, result);
}

/// A bed that falls as the keys of settling prescribe.
Archive settled_bed(const DemOptions& options, const ProgressCall& progress, SettleResult& result) {
  const DemOptions first = falling(options);
  GrainSolver solver(settling_params(options));
  solver.place(starting_positions(options, progress));
  const double drag = fall_drag(options), fall = solver.top() * drag / options.gravity.norm();
  result = settle(solver, first, progress, kMaxSettleTime + fall, drag);
  const auto go_on = [&](double drag_then) {
    const SettleResult before = result;
    result = settle(solver, options, progress, kMaxSettleTime, drag_then);
    result.time += before.time;
    result.steps += before.steps;
  };
  if (options.compaction_pressure > 0.0) {
    const std::vector<Quad> positions = compacted_positions(solver, first, progress);
    solver = GrainSolver(settling_params(options));
    solver.place(positions);
    go_on(kFallDrag);
  } else if (first.friction != options.friction || first.cohesion != options.cohesion || drag > kRestDrag) {
    go_on(kRestDrag);
  }
  return bed_archive(solver, options, result);
}

BedStatistics statistics_of(const GrainSolver& solver, const DemOptions& options) {
  return bed_statistics(positions_by_id(solver), solver.params().bin, options.radius);
}
BedStatistics statistics_of(const Archive& bed, const DemOptions& options) {
  GrainSolver solver(settling_params(options));
  solver.restore(bed);
  return statistics_of(solver, options);
}

/// A bed with the prescribed solid fraction. The settings for it are searched on a sample, whose beds are cached like
/// any other. Walls and chance make the bed itself differ a little, so a few are made and the nearest is taken.
Archive packed_bed(const DemOptions& options, const ProgressCall& progress, SettleResult& result) {
  const double wanted = options.solid_fraction, tolerance = packing_tolerance(wanted);
  DemOptions as = options;
  as.solid_fraction = -1.0;
  Archive best;
  double nearest = INFINITY;
  const auto settle_it = [&] {  // returns the excess of its solid fraction
    SettleResult settled;
    Archive bed = settled_bed(as, progress, settled);
    const double reached = statistics_of(bed, as).solid_fraction_bulk, excess = reached - wanted;
    if (std::abs(excess) < nearest) {
      nearest = std::abs(excess);
      best = std::move(bed), result = settled;
      best.put("bed/packing", std::vector<double>{as.settling_friction, as.settling_cohesion, as.settling_drag});
      best.put(kReached, reached);
    }
    return excess;
  };
  const DemOptions sample = sample_of(options);
  const bool small = expected_grains(options) < kSmallBed * expected_grains(sample);
  PackingSearch search([&](double looseness) {
    if (small) {
      as = laid(as, looseness);
      return wanted + settle_it();
    }
    const DemOptions tried = laid(sample, looseness);
    return statistics_of(prepare_bed(tried, named("a sample of the bed: ", progress)).bed, tried).solid_fraction_bulk;
  });
  if (std::max({as.settling_friction, as.settling_cohesion, as.settling_drag}) >= 0.0) settle_it();
  if (nearest <= tolerance) return best;
  double looseness = search.looseness_for(wanted), sum = 0.0;
  if (std::abs(looseness) == 1.0 && std::abs(search.at(looseness) - wanted) > tolerance)
    throw input_error(options.scenario, "terrain.solid_fraction",
                      fmt::format("is {:g}, but these grains (friction {:g}, rolling friction {:g}, cohesion {:g} Pa) "
                                  "lie between {:.3f} and {:.3f}; expected a value between, or other grains",
                                  wanted, options.friction, options.rolling_friction, options.cohesion,
                                  search.loosest(), search.densest()));
  for (int k = 1; k <= kMostPackings && nearest > tolerance; ++k) {
    as = laid(as, looseness);
    sum += looseness + settle_it() / search.slope(looseness);
    looseness = std::clamp(sum / k, -1.0, 1.0);
  }
  return best;
}

Archive made_bed(const DemOptions& options, const ProgressCall& progress, SettleResult& result) {
  if (is_tiled(options)) return tiled_bed(options, progress, result);
  const bool generated = options.bed.empty();
  return generated && options.solid_fraction > 0.0 ? packed_bed(options, progress, result)
                                                   : settled_bed(options, progress, result);
}

void read_settled(PreparedBed& prepared) {
  const auto& settled = prepared.bed.get<double>("bed/settled", 4);
  prepared.settled.settled = settled[0] != 0.0;
  prepared.settled.force_ratio = settled[1];
  prepared.settled.floor_error = settled[2];
  prepared.settled.time = settled[3];
}

/// If the cache cannot be written, the run only loses time.
bool keep(const std::filesystem::path& file, const DemOptions& options, Archive& bed, const ProgressCall& progress) {
  if (file.empty()) return false;
  try {
    keep_bed(file, bed, bed_digest(options), progress);
    return true;
  } catch (const Error& error) {
    if (error.code() != ExitCode::io) throw;
    if (progress) progress(std::string("bed not cached: ") + error.what(), 1.0);
    return false;
  }
}

/// A newly settled bed, whatever the cache contains.
PreparedBed settled_anew(const DemOptions& options, const std::filesystem::path& file, const ProgressCall& progress) {
  PreparedBed prepared;
  prepared.bed = made_bed(options, progress, prepared.settled);
  if (keep(file, options, prepared.bed, progress)) prepared.file = file;
  read_settled(prepared);
  return prepared;
}

}  // namespace

DemOptions level(DemOptions o) {
  const double strength = o.gravity.norm();
  const bool standard = std::abs(strength - kStandardGravity) <= 1e-9 * kStandardGravity;
  o.gravity = standard ? standard_gravity() : Vec3(0.0, 0.0, -strength);
  return o;
}

double solid_fraction_under_weight(const GrainSolver& bed, const DemOptions& options, const ProgressCall& progress) {
  DemOptions heavier = options;
  heavier.gravity *= 1.2;
  Archive state;
  bed.save(state);
  GrainSolver solver(settling_params(heavier));
  solver.restore(state);
  settle(solver, heavier, named("more gravity: ", progress), kMaxSettleTime, kRestDrag);
  return statistics_of(solver, options).solid_fraction_bulk;
}

bool bed_is_settled_anew(const DemOptions& options) { return options.bed.empty() || is_positions_file(options.bed); }

Archive bed_archive(const GrainSolver& solver, const DemOptions& options, const SettleResult& settled) {
  Archive bed;
  solver.save(bed);
  bed.put("bed/settled",
          std::vector<double>{settled.settled ? 1.0 : 0.0, settled.force_ratio, settled.floor_error, settled.time});
  bed.put("bed/geometry", geometry(options));
  bed.put("bed/size_spread", options.size_spread);
  bed.put("bed/periodic_sides", std::int64_t{options.periodic_y()});
  bed.put("bed/law", std::vector<std::uint8_t>(options.law.begin(), options.law.end()));
  return bed;
}

void check_bed_options(const DemOptions& o) {
  check_tiling(o);
  check_packing(o);
  if (o.compaction_pressure > 0.0 && !bed_is_settled_anew(o))
    throw input_error(o.scenario, "terrain.compaction_pressure",
                      fmt::format("is {:g} Pa but the bed '{}' is a settled one and taken as it is, expected 0",
                                  o.compaction_pressure, o.bed));
}

PreparedBed prepare_bed(const DemOptions& options, const ProgressCall& progress) {
  check_bed_options(options);
  PreparedBed prepared;
  if (!bed_is_settled_anew(options)) {
    prepared.bed = read_bed(options.bed, progress);
    check_bed(prepared.bed, options);
    prepared.file = options.bed;
  } else {
    prepared.file = options.cache ? bed_cache_file(bed_digest(options)) : std::filesystem::path();
    prepared.from_cache = from_cache(prepared.file, options, prepared.bed, progress);
    if (!prepared.from_cache) return settled_anew(options, prepared.file, progress);
  }
  read_settled(prepared);
  return prepared;
}

PreparedBed load_bed(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress) {
  PreparedBed prepared = prepare_bed(options, progress);
  try {
    solver.restore(prepared.bed);
  } catch (const Error& error) {
    const std::string text = prepared.file.string() + ": " + error.what();
    if (!prepared.from_cache) throw Error(error.code(), text);
    if (progress) progress(kWarning + text + "; the bed is settled anew and the file replaced", 1.0);
    prepared = settled_anew(options, prepared.file, progress);
    solver.restore(prepared.bed);
  }
  if (options.solid_fraction > 0.0 && progress) {
    const double is = prepared.bed.has(kReached) ? prepared.bed.get_double(kReached)
                                                 : statistics_of(solver, options).solid_fraction_bulk;
    if (std::abs(is - options.solid_fraction) > packing_tolerance(options.solid_fraction))
      progress(fmt::format("{}the bed has a solid fraction of {:.4f}, terrain.solid_fraction asks for {:g}", kWarning,
                           is, options.solid_fraction),
               1.0);
  }
  return prepared;
}

}  // namespace furrow::terrain::dem
