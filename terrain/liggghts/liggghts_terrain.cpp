#include "terrain/liggghts/liggghts_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/fault_point.hpp"
#include "terrain/dem/accounts/stored_energy.hpp"
#include "terrain/dem/beds/bed_height.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/refinement/step_refinement.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/dem/solver_state_check.hpp"
#include "terrain/dem/tires/bin_sides.hpp"
#include "terrain/dem/tires/surface_start.hpp"
#include "terrain/liggghts/borders.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/rank_contacts.hpp"
#include "terrain/liggghts/rank_frames.hpp"
#include "terrain/liggghts/rank_reports.hpp"
#include "terrain/liggghts/rank_states.hpp"
#include "terrain/liggghts/saved_grains.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain {
namespace {

using namespace liggghts;

constexpr double kMostImbalance = 0.05;  // with more, the borders move
constexpr int kBalanceEvery = 500;       // intervals: moving borders costs about as much as ten steps

class LiggghtsTerrain final : public Terrain {
 public:
  explicit LiggghtsTerrain(const dem::DemOptions& options)
      : options_(options), contacts_(options), refinement_(options), dt_(options.step), part_(options.step) {
    refinement_.set_step(dt_);
    if (group() && group()->size() > 1 && !group()->communicator())
      throw input_error(options.scenario, "terrain.ranks", "of engine 'liggghts' need MPI, expected 1 without it");
    require_engine_library();
  }

  double do_prepare(const ProgressCall& progress) override {
    const double begin = wall_clock();
    StartingBed bed;
    dem::Stored stored;
    double elastic = 0.0;
    if (leads()) {
      dem::GrainSolver solver(dem::solver_params(options_));
      solver.set_coefficients(contacts_.coefficients());
      const dem::PreparedBed prepared = dem::load_bed(solver, dem::level(options_), progress);
      solver.reset_accounts();
      bed = starting_bed(solver);
      elastic = solver.accounts().elastic;
      stored = solver.energies().state().stored;
      if (progress && !prepared.settled.settled) progress("bed not settled", 1.0);
    }
    share(group(), bed);
    if (ranks() > 1) {
      Crowd crowd(options_.length);
      for (const NewGrain& grain : bed.grains) crowd.add(grain.position[0]);
      borders_ = crowd.borders(ranks());
    }
    start(bed, false, false);
    contacts_.sum_motion(engine_->own());
    contacts_.begin_accounts(stored, elastic);
    return wall_clock() - begin;
  }

  double gather_top_height(double x_min, double x_max, double y_min, double y_max) const override {
    double top = dem::top_height(own_grains(), x_min, x_max, y_min, y_max);
    if (group())
      for (const double other : gather_on_all<double>(*group(), std::span<const double>(&top, 1)))
        top = std::max(top, other);
    return top;
  }
  double gather_mean_height(double x_min, double x_max, double y_min, double y_max) const override {
    return dem::mean_height(gather_height_field(), x_min, x_max, y_min, y_max);
  }
  double floor_height() const override { return 0.0; }
  HeightField gather_height_field() const override {
    HeightField field = dem::bed_height_field(own_grains(), contacts_.params().bin, 2.0 * options_.radius);
    merge_heights(group(), field);
    return field;
  }

  void do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) override {
    dem::check_surface_start(options_, contacts_.params().bin, material, start, contacts_.tires());
    contacts_.attach(mesh, material, start);
  }

  Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                     std::span<NodalForces> forces, std::span<ContactSums> sums) override {
    if (const double dt = duration / substeps; dt != dt_) {
      dt_ = dt;
      refinement_.set_step(dt);
    }
    const int parts = 1 << refinement_.level(), steps = substeps * parts;
    const double part = dt_ / parts;
    if (part != part_) set_part(part);
    contacts_.begin_interval(targets, duration, steps);
    for (int k = 0; k < contacts_.tires(); ++k)
      if (const char* wall = dem::side_crossed(contacts_.params().bin, contacts_.swept_bounds(k)))
        return Outcome::failure("is too small", fmt::format("tire {} reached {} of the bin", k, wall));
    run(steps, part);
    contacts_.end_interval(duration, forces, sums);
    for (int s = 0; s < substeps; ++s) refinement_.count(parts);
    SharedReports shared = share_reports(group(), contacts_.interval(), own_state(), forces, sums);
    states_ = std::move(shared.states);
    if (Outcome outcome = judge(shared.intervals); !outcome.ok) return outcome;
    for (const ContactSums& one : sums) surface_work_ -= one.work;
    if (ranks() > 1 && ++since_balance_ >= kBalanceEvery) balance();
    return {};
  }

  TerrainState gather_state() const override {
    StateReport all;
    if (engine_)
      for (const StateReport& one : states_.empty() ? gather_states(group(), own_state()) : states_) add(all, one);
    TerrainState s = terrain_state(all, contacts_.grain(), options_.gravity, surface_work_);
    refinement_.report(s);
    return s;
  }

  std::int64_t size() const override { return size_; }
  std::int64_t grains_here() const override { return engine_ ? engine_->own().count : 0; }

  void gather_frame(TerrainFrame& out) const override {
    liggghts::gather_frame(group(), engine_->own(), contacts_.params().bin, out);
  }

  void save(Archive& archive) const override {
    const Archive::Scope scope(archive, "terrain/");
    archive.put("step", dt_);
    archive.put("part", part_);
    archive.put("since", since_);
    archive.put("surface_work", surface_work_);
    archive.put("grains/all", size_);
    archive.put("top", top_);
    archive.put("borders", borders_);
    archive.put("since_balance", static_cast<std::int64_t>(since_balance_));
    archive.put("exchange_due", static_cast<std::int64_t>(engine_->exchange_due() ? 1 : 0));
    refinement_.save(archive);
    contacts_.save(archive);
    save_grains(*engine_, contacts_.carried(engine_->own()), archive);
  }

  void do_restore(const Archive& archive) override {
    const Archive::Scope scope(archive, "terrain/");
    dt_ = archive.get_double("step");
    since_ = archive.get_double("since");
    surface_work_ = archive.get_double("surface_work");
    top_ = archive.get_double("top");
    borders_ = archive.get<double>("borders", static_cast<std::size_t>(ranks() - 1));
    since_balance_ = static_cast<int>(archive.get_int("since_balance"));
    refinement_.set_step(dt_);
    refinement_.restore(archive);
    contacts_.restore(archive);
    size_ = archive.get_int("grains/all");
    start(read_grains(archive, size_), true, archive.get_int("exchange_due") != 0);
    set_part(archive.get_double("part"));
  }

 private:
  std::size_t attached() const override { return contacts_.tires(); }
  std::size_t vertices(std::size_t k) const override { return contacts_.vertices(static_cast<int>(k)); }

  RankGroup* group() const { return options_.group.get(); }
  int ranks() const { return group() ? group()->size() : 1; }
  bool leads() const { return !group() || group()->rank() == 0; }

  void set_part(double part) {
    part_ = part;
    contacts_.set_step(part);
    if (engine_) engine_->set_coefficients(contacts_.coefficients().pair);
  }

  EngineSetup setup() const {
    EngineSetup s = contacts_.setup();
    if (ranks() > 1) s.communicator = group()->communicator();
    s.top = top_;
    s.borders = borders_;
    return s;
  }

  /// Makes a new engine with these grains. @param exchange  as for Engine::begin
  void start(const StartingBed& bed, bool own_only, bool exchange) {
    if (!own_only) size_ = bed.size(), top_ = bed.top;
    engine_.reset();
    contacts_.forget_grains();
    states_.clear();
    try {
      engine_ = make_engine(setup());
      engine_->set_coefficients(contacts_.coefficients().pair);
      engine_->place(bed.grains, own_only);
      engine_->remember(bed.pairs);
      engine_->begin(contacts_, exchange);
    } catch (const EngineError& error) {
      engine_failed(error);
    }
    const OwnGrains own = engine_->own();
    hand_out(bed.walls, own);
    std::int64_t all = own.count;
    if (group()) {
      const auto counts = gather_on_all<std::int64_t>(*group(), std::span<const std::int64_t>(&all, 1));
      all = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
    }
    if (all != size_)
      throw physics_error(Outcome::failure("cannot begin", fmt::format("LIGGGHTS holds {} of {} grains", all, size_)),
                          "terrain");
  }

  void run(int steps, double part) {
    const double since = since_ > 0.0 ? since_ : part;
    since_ = part;
    const auto go = [&](int count, const StepTimes& times) {
      contacts_.set_times(times);
      engine_->run(count, times);
    };
    try {
      if (const std::string line = fault_text("liggghts"); !line.empty()) engine_->command(line);
      const int first = since == part ? 0 : 1;
      if (first > 0) go(1, {part, since, 0.5 * (since + part)});
      if (steps > first) go(steps - first, {part, part, part});
    } catch (const EngineError& error) {
      engine_failed(error);
    }
  }

  /// The other ranks do not receive an error on this rank alone, so they are ended with it.
  [[noreturn]] void engine_failed(const EngineError& error) const {
    throw Error(ExitCode::rank_lost, fmt::format("terrain {}: LIGGGHTS failed{}: {}", group() ? group()->rank() : 0,
                                                 error.on_all ? "" : " on this rank", error.what()));
  }

  Outcome judge(std::span<const IntervalReport> reports) {
    dem::HardContacts hard;
    for (const IntervalReport& one : reports) {
      if (one.lost >= 0.0)
        return Outcome::failure(fmt::format("lost grain {:.0f}", one.lost),
                                fmt::format("it left the bin or is not finite, x = ({:.6g}, {:.6g}, {:.6g}) m",
                                            one.lost_at.x(), one.lost_at.y(), one.lost_at.z()));
      hard.overlap = std::max(hard.overlap, one.overlap);
      if (one.share <= hard.share) continue;
      hard.share = one.share, hard.deepest = one.overlap, hard.at = one.hardest_at;
      hard.count = hard.past = 1;
      hard.between = "a grain and what it touches";
    }
    return refinement_.follow(hard);
  }

  /// Moves the borders if some rank owns too many grains. All ranks see the same numbers.
  void balance() {
    since_balance_ = 0;
    const OwnGrains own = engine_->own();
    const std::int64_t mine = own.count;
    const auto counts = gather_on_all<std::int64_t>(*group(), std::span<const std::int64_t>(&mine, 1));
    if (imbalance(counts) <= kMostImbalance) return;
    Crowd crowd(options_.length);
    for (int g = 0; g < own.count; ++g) crowd.add(own.position[g][0]);
    crowd.set_sum_of(gather_on_all<std::int64_t>(*group(), crowd.counts()));
    borders_ = crowd.borders(ranks());
    states_.clear();
    try {
      engine_->move_borders(borders_);
    } catch (const EngineError& error) {
      engine_failed(error);
    }
    contacts_.sum_motion(engine_->own());
  }

  StateReport own_state() const {
    return state_report(contacts_, engine_->own().count, static_cast<double>(size_),
                        static_cast<double>(engine_->list_builds()));
  }

  dem::Grains own_grains() const { return grains_of(engine_->own(), contacts_.params().bin); }

  dem::DemOptions options_;
  RankContacts contacts_;
  dem::StepRefinement refinement_;
  std::unique_ptr<Engine> engine_;   // uses contacts_
  std::int64_t size_ = 0;            // grains of all ranks
  std::vector<double> borders_;      // between the ranks' parts along x, m
  int since_balance_ = 0;            // intervals since the borders were checked
  std::vector<StateReport> states_;  // of all ranks since the last interval, on the leader; empty: not gathered yet
  double top_ = 0.0;                 // of the bed at the beginning, m
  double dt_, part_;                 // the step, and the part of it for which contacts are evaluated, s
  double since_ = 0.0;               // time since forces were last evaluated, s; 0: never
  double surface_work_ = 0.0;        // by tires on the grains, J
};

}  // namespace

std::unique_ptr<Terrain> make_liggghts_terrain(const dem::DemOptions& options) {
  check_dem_run(options);
  return std::make_unique<LiggghtsTerrain>(options);
}

}  // namespace furrow::terrain
