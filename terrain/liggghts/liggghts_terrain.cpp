#include "terrain/liggghts/liggghts_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <unordered_map>
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
#include "terrain/dem/tires/bin_sides.hpp"
#include "terrain/dem/tires/surface_start.hpp"
#include "terrain/liggghts/borders.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/rank_contacts.hpp"
#include "terrain/liggghts/rank_reports.hpp"
#include "terrain/liggghts/saved_grains.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain {
namespace {

using namespace liggghts;

constexpr double kRoom =
    10.0;  // around a rank's grains for what they may move in one interval, largest radii
constexpr double kMostImbalance = 0.05;       // above it the borders move
constexpr int kBalanceEvery = 500;            // intervals: moving borders costs about as much as ten steps
constexpr char kRefinement[] = "refinement";  // in the saved state

Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

class LiggghtsTerrain final : public Terrain {
 public:
  explicit LiggghtsTerrain(const dem::DemOptions& options)
      : options_(options), contacts_(options), refinement_(options), dt_(options.step), part_(options.step) {
    refinement_.set_step(dt_);
    if (group() && group()->size() > 1 && !group()->communicator())
      throw input_error(options.scenario, "terrain.ranks",
                        "of engine 'liggghts' need MPI, expected 1 without it");
    require_engine_library();
  }

  double prepare(const ProgressCall& progress) override {
    const double begin = wall_clock();
    StartingBed bed;
    dem::Stored stored;
    double elastic = 0.0;
    if (leads()) {
      const dem::PreparedBed prepared = dem::prepare_bed(dem::level(options_), progress);
      dem::GrainSolver solver(dem::solver_params(options_));
      solver.set_coefficients(contacts_.coefficients());
      dem::restore_bed(solver, prepared);
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
    start(bed, false);
    contacts_.begin_accounts(stored, elastic);
    return wall_clock() - begin;
  }

  double top_height(double x_min, double x_max, double y_min, double y_max) const override {
    double top = dem::top_height(own_grains(), x_min, x_max, y_min, y_max);
    if (group())
      for (const double other : gather_on_all<double>(*group(), std::span<const double>(&top, 1)))
        top = std::max(top, other);
    return top;
  }
  double mean_height(double x_min, double x_max, double y_min, double y_max) const override {
    return dem::mean_height(height_field(), x_min, x_max, y_min, y_max);
  }
  double floor_height() const override { return 0.0; }
  HeightField height_field() const override {
    HeightField field = dem::bed_height_field(own_grains(), contacts_.params().bin, 2.0 * options_.radius);
    merge_heights(group(), field);
    return field;
  }

  void attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) override {
    dem::check_surface_start(options_, contacts_.params().bin, mesh, material, start, contacts_.tires());
    contacts_.attach(mesh, material, start);
  }

  Outcome advance(std::span<const SurfaceState> targets, double duration, int substeps,
                  std::span<NodalForces> forces, std::span<ContactSums> sums) override {
    FURROW_ASSERT(duration > 0.0 && substeps > 0, duration, substeps);
    if (const double dt = duration / substeps; dt != dt_) {
      dt_ = dt;
      refinement_.set_step(dt);
    }
    const int parts = 1 << refinement_.level(), steps = substeps * parts;
    const double part = dt_ / parts;
    if (part != part_) set_part(part);
    if (!now_) now_ = look();
    contacts_.begin_interval(targets, duration, steps, with_room(now_->box));
    for (int k = 0; k < contacts_.tires(); ++k)
      if (const char* wall = dem::side_crossed(contacts_.params().bin, contacts_.swept_bounds(k)))
        return Outcome::failure("is too small", fmt::format("tire {} reached {} of the bin", k, wall));
    run(steps, part);
    contacts_.end_interval(duration, forces, sums);
    for (int s = 0; s < substeps; ++s) refinement_.count(parts);
    time_ += duration;
    now_ = look();
    SharedReports shared = share_reports(group(), own_interval(), now_->report, forces, sums);
    states_ = std::move(shared.states);
    if (Outcome outcome = judge(shared.intervals); !outcome.ok) return outcome;
    for (const ContactSums& one : sums) surface_work_ -= one.work;
    if (ranks() > 1 && ++since_balance_ >= kBalanceEvery) balance();
    return {};
  }

  TerrainState state() const override {
    StateReport all;
    if (engine_)
      for (const StateReport& one : states_.empty() ? gather_states(group(), look().report) : states_)
        add(all, one);
    TerrainState s;
    const double strength = options_.gravity.norm();
    s.kinetic_energy = all.kinetic + all.rotational;
    s.potential_energy = strength * all.height_moment;
    s.elastic_energy = all.sums.elastic;
    s.momentum = all.momentum;
    s.wall_impulse = all.sums.wall_impulse;
    s.surface_impulse = all.sums.surface_impulse;
    s.floor_force = all.sums.floor_force;
    s.contacts = std::llround(all.sums.contacts);
    s.active = std::llround(all.grains);
    s.list_rebuilds = std::llround(all.list_builds);
    s.substeps_added = refinement_.state().added;
    s.refined_time = refinement_.state().time;
    s.most_parts = 1 << refinement_.state().finest;
    TerrainEnergies& e = s.energies;
    e.kinetic = all.kinetic;
    e.rotational = all.rotational;
    e.potential = s.potential_energy;
    e.elastic_normal = all.sums.elastic - all.stored.cohesion;
    e.elastic_tangential = all.stored.tangential;
    e.cohesion = all.stored.cohesion;
    e.sliding_loss = all.lost.sliding;
    e.normal_damping_loss = all.lost.normal_damping;
    e.tangential_damping_loss = all.lost.tangential_damping;
    e.rolling_loss = all.lost.rolling;
    e.opening_loss = all.lost.opening;
    e.sample_error = std::sqrt(all.error2);
    e.surface_work = surface_work_;
    s.dissipation = e.losses();
    const Vec3 gravity = contacts_.sums().gravity_time * all.mass * options_.gravity;
    s.momenta = {s.momentum, gravity, s.wall_impulse, s.surface_impulse, Vec3::Zero()};
    return s;
  }

  std::int64_t size() const override { return size_; }
  std::int64_t grains_here() const override { return engine_ ? engine_->own().count : 0; }

  /// The whole frame on the leader, grains in the order of their numbers; nothing on the others.
  void frame(TerrainFrame& out) const override {
    struct Row {
      double id;
      float x, y, z, radius, speed;
    };
    const OwnGrains g = engine_->own();
    std::vector<Row> rows(g.count);
    for (int k = 0; k < g.count; ++k) {
      dem::Quad at{g.position[k][0], g.position[k][1], g.position[k][2], 0.0};
      contacts_.params().bin.wrap(at);
      const double* const v = g.velocity[k];
      rows[k] = {static_cast<double>(g.id[k]),
                 static_cast<float>(at.x),
                 static_cast<float>(at.y),
                 static_cast<float>(at.z),
                 static_cast<float>(g.radius[k]),
                 static_cast<float>(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]))};
    }
    if (group()) rows = gather_on_all<Row>(*group(), rows);
    out.position.clear(), out.speed.clear(), out.radius.clear();
    if (!leads()) return;
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    for (const Row& row : rows) {
      out.position.insert(out.position.end(), {row.x, row.y, row.z});
      out.speed.push_back(row.speed);
      out.radius.push_back(row.radius);
    }
  }

  void save(Archive& archive) const override {
    const Archive::Scope scope(archive, "terrain/");
    archive.put("time", time_);
    archive.put("step", dt_);
    archive.put("part", part_);
    archive.put("since", since_);
    archive.put("surface_work", surface_work_);
    archive.put("grains/all", size_);
    archive.put("top", top_);
    archive.put("borders", borders_);
    archive.put("since_balance", static_cast<std::int64_t>(since_balance_));
    if (refinement_.used()) save_fields(archive, kRefinement, refinement_.state());
    contacts_.save(archive);
    save_grains(*engine_, archive);
  }

  void restore(const Archive& archive) override {
    const Archive::Scope scope(archive, "terrain/");
    time_ = archive.get_double("time");
    dt_ = archive.get_double("step");
    since_ = archive.get_double("since");
    surface_work_ = archive.get_double("surface_work");
    top_ = archive.get_double("top");
    borders_ = archive.get<double>("borders", static_cast<std::size_t>(ranks() - 1));
    since_balance_ = static_cast<int>(archive.get_int("since_balance"));
    refinement_.set_step(dt_);
    dem::StepRefinement::State refined;
    if (archive.has(std::string(kRefinement) + "/level")) restore_fields(archive, kRefinement, refined);
    refinement_.restore(refined);
    contacts_.restore(archive);
    size_ = archive.get_int("grains/all");
    start(read_grains(archive, size_, contacts_.tires()), true);
    set_part(archive.get_double("part"));
  }

 private:
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

  /// Makes the engine anew with these grains.
  void start(const StartingBed& bed, bool own_only) {
    if (!own_only) size_ = bed.size(), top_ = bed.top;
    engine_.reset();
    forget();
    try {
      engine_ = make_engine(setup());
      engine_->set_coefficients(contacts_.coefficients().pair);
      engine_->place(bed.grains, own_only);
      engine_->remember(bed.pairs);
      engine_->begin(contacts_);
    } catch (const EngineError& error) {
      engine_failed(error);
    }
    std::unordered_map<int, std::vector<Carried>> carried;
    for (const CarriedBy& one : bed.walls) carried[one.grain].push_back(one.contact);
    const OwnGrains own = engine_->own();
    for (int g = 0; g < own.count; ++g)
      if (const auto found = carried.find(own.id[g] - 1); found != carried.end())
        own.carried[g] = found->second;
    std::int64_t all = own.count;
    if (group()) {
      const auto counts = gather_on_all<std::int64_t>(*group(), std::span<const std::int64_t>(&all, 1));
      all = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
    }
    if (all != size_)
      throw physics_error(
          Outcome::failure("cannot begin", fmt::format("LIGGGHTS holds {} of {} grains", all, size_)),
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

  /// Of an error on this rank alone the others do not hear: they are ended with it.
  [[noreturn]] void engine_failed(const EngineError& error) const {
    throw Error(ExitCode::rank_lost,
                fmt::format("terrain {}: LIGGGHTS failed{}: {}", group() ? group()->rank() : 0,
                            error.on_all ? "" : " on this rank", error.what()));
  }

  IntervalReport own_interval() const {
    IntervalReport own;
    if (const auto& lost = contacts_.lost()) own.lost = lost->id, own.lost_at = vec(lost->position);
    own.overlap = contacts_.interval_overlap();
    own.share = contacts_.hardest_share();
    own.hardest_at = vec(contacts_.hardest_at());
    return own;
  }

  /// How the interval ended, alike on all ranks.
  Outcome judge(std::span<const IntervalReport> reports) {
    dem::HardContacts hard;
    for (const IntervalReport& one : reports) {
      if (one.lost >= 0.0)
        return Outcome::failure(
            fmt::format("lost grain {:.0f}", one.lost),
            fmt::format("it left the bin or is not finite, x = ({:.6g}, {:.6g}, {:.6g}) m", one.lost_at.x(),
                        one.lost_at.y(), one.lost_at.z()));
      hard.overlap = std::max(hard.overlap, one.overlap);
      if (one.share <= hard.share) continue;
      hard.share = one.share, hard.deepest = one.overlap, hard.at = one.hardest_at;
      hard.count = hard.past = 1;
      hard.between = "a grain and what it touches";
    }
    return refinement_.follow(hard);
  }

  /// Moves the borders where some rank owns too many grains. All ranks see the same numbers.
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
    forget();
    try {
      engine_->move_borders(borders_);
    } catch (const EngineError& error) {
      engine_failed(error);
    }
  }

  /// This rank's grains, as they are between two intervals.
  struct Look {
    StateReport report;
    SurfaceBox box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};  // of the centres
  };

  Look look() const {
    Look now;
    StateReport& r = now.report;
    const OwnGrains g = engine_->own();
    const dem::GrainProperties& grain = contacts_.grain();
    const double strength = options_.gravity.norm();
    const Vec3 up = strength > 0.0 ? Vec3(-options_.gravity / strength) : Vec3::UnitZ();
    // Sums of their own: those of the report could be what the grains' pointers point at, and would be stored each time.
    double all = 0.0, kinetic = 0.0, rotational = 0.0, height_moment = 0.0;
    Vec3 momentum = Vec3::Zero(), lo = now.box.lo, hi = now.box.hi;
    for (int k = 0; k < g.count; ++k) {
      double mass = grain.mass, inertia = grain.inertia;
      if (g.radius[k] != grain.radius) {
        const double size = g.radius[k] / grain.radius, volume = size * size * size;
        mass *= volume, inertia *= volume * size * size;
      }
      const Vec3 x(g.position[k]), v(g.velocity[k]), w(g.spin[k]);
      all += mass;
      kinetic += 0.5 * mass * v.squaredNorm();
      rotational += 0.5 * inertia * w.squaredNorm();
      height_moment += mass * up.dot(x);
      momentum += mass * v;
      for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], x[axis]);
        hi[axis] = std::max(hi[axis], x[axis]);
      }
    }
    now.box = {lo, hi};
    r.mass = all;
    r.kinetic = kinetic, r.rotational = rotational, r.height_moment = height_moment;
    r.momentum = momentum;
    r.grains = g.count;
    r.sums = contacts_.sums();
    r.lost = contacts_.energies().lost();
    r.stored = contacts_.energies().state().stored;
    r.error2 = contacts_.energies().state().error2;
    r.list_builds = g.count * static_cast<double>(engine_->list_builds()) / static_cast<double>(size_);
    return now;
  }

  /// What was seen of the grains holds no longer.
  void forget() { now_.reset(), states_.clear(); }

  static void add(StateReport& to, const StateReport& one) {
    to.grains += one.grains;
    to.mass += one.mass;
    to.kinetic += one.kinetic;
    to.rotational += one.rotational;
    to.height_moment += one.height_moment;
    to.momentum += one.momentum;
    to.sums.elastic += one.sums.elastic;
    to.sums.wall_impulse += one.sums.wall_impulse;
    to.sums.surface_impulse += one.sums.surface_impulse;
    to.sums.floor_force += one.sums.floor_force;
    to.sums.contacts += one.sums.contacts;
    dem::add(to.lost, one.lost, 1.0);
    dem::add(to.stored, one.stored, 1.0);
    to.error2 += one.error2;
    to.list_builds += one.list_builds;
  }

  dem::Grains own_grains() const {
    const OwnGrains g = engine_->own();
    dem::Grains grains;
    grains.resize(g.count);
    for (int k = 0; k < g.count; ++k) {
      grains.position[k] = {g.position[k][0], g.position[k][1], g.position[k][2], g.radius[k]};
      contacts_.params().bin.wrap(grains.position[k]);
      grains.id[k] = g.id[k] - 1;
    }
    return grains;
  }

  /// With room for what grains may move in one interval.
  SurfaceBox with_room(SurfaceBox box) const {
    const double room = kRoom * dem::largest_radius(options_);
    box.lo.array() -= room, box.hi.array() += room;
    return box;
  }

  dem::DemOptions options_;
  RankContacts contacts_;
  dem::StepRefinement refinement_;
  std::unique_ptr<Engine> engine_;  // uses contacts_
  std::int64_t size_ = 0;           // grains of all ranks
  std::vector<double> borders_;     // between the ranks' parts along x, m
  int since_balance_ = 0;           // intervals since they were looked at
  std::optional<Look> now_;         // since the last interval; none: not looked yet
  std::vector<StateReport>
      states_;                 // of all ranks since the last interval, on the leader; empty: not asked yet
  double top_ = 0.0;           // of the bed at the beginning, m
  double dt_, part_;           // the step, and the part of it that contacts are evaluated for, s
  double since_ = 0.0;         // forces were last taken, s; 0: not yet
  double time_ = 0.0;          // advanced, s
  double surface_work_ = 0.0;  // by tires on the grains, J
};

}  // namespace

std::unique_ptr<Terrain> make_liggghts_terrain(const dem::DemOptions& options) {
  check_dem_run(options);
  return std::make_unique<LiggghtsTerrain>(options);
}

}  // namespace furrow::terrain
