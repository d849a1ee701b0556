#include "terrain/dem/dem_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/key_schema.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_height.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/refinement/step_refinement.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/dem/solver_state_check.hpp"
#include "terrain/dem/tires/bin_sides.hpp"
#include "terrain/dem/tires/surface_start.hpp"

namespace furrow::terrain {
namespace {

using namespace dem;

constexpr double kMostGrains = 2e9;  // grains are counted in 32 bits
constexpr double kGrainsOfThread = 2500.0;
constexpr double kLooseFraction = 0.50;        // estimated solid fraction of a bed that settled with cohesion
constexpr double kBytesPerGrain = 900.0;       // state, list with history, and the copies of a rebuild
constexpr double kBytesPerFrameGrain = 20.0;   // position, speed, radius in single precision
constexpr double kBytesPerSavedGrain = 300.0;  // in a checkpoint: state, pair list, contact history

void check(const DemOptions& o) {
  check_values(o, o.scenario, "terrain");
  for (const auto& [key, size] : {std::pair{"terrain.length", o.length}, {"terrain.width", o.width}})
    if (size < 4.0 * o.radius)
      throw input_error(o.scenario, key,
                        fmt::format("is {:g} m, expected at least {:g} m, two grains", size, 4.0 * o.radius));
  dem::check_sizes(o);
  dem::check_bed_options(o);
  if (!(o.step > 0.0))
    throw input_error(o.scenario, "run.step", fmt::format("{} is out of range, expected a positive number, s", o.step));
}

class DemTerrain : public Terrain {
 public:
  DemTerrain(const DemOptions& options, std::function<void()> each_substep)
      : options_(options),
        each_substep_(std::move(each_substep)),
        solver_(dem::solver_params(options)),
        refinement_(options),
        dt_(options.step),
        part_(options.step) {
    solver_.surfaces().give_tangents(options.contact_tangents);
    set_step(dt_);
  }

  double do_prepare(const ProgressCall& progress) override {
    const double begin = wall_clock();
    // A run from a cached bed and the run that settled this bed both start here, from the same archive.
    const dem::PreparedBed prepared = dem::load_bed(solver_, dem::level(options_), progress);
    solver_.set_threads(std::max(1, options_.threads));
    set_step(dt_);
    solver_.reset_accounts();
    surface_work_ = 0.0;
    if (progress && !prepared.settled.settled) progress("bed not settled", 1.0);
    return wall_clock() - begin;
  }

  double gather_top_height(double x_min, double x_max, double y_min, double y_max) const override {
    FURROW_ASSERT(x_min <= x_max && y_min <= y_max, x_min, x_max, y_min, y_max);
    return dem::top_height(solver_.grains(), x_min, x_max, y_min, y_max);
  }
  double gather_mean_height(double x_min, double x_max, double y_min, double y_max) const override {
    return dem::mean_height(gather_height_field(), x_min, x_max, y_min, y_max);
  }
  double floor_height() const override { return 0.0; }
  HeightField gather_height_field() const override {
    return dem::bed_height_field(solver_.grains(), solver_.params().bin, 2.0 * options_.radius);
  }

  void do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) override {
    dem::check_surface_start(options_, solver_.params().bin, material, start, solver_.surfaces().count());
    solver_.surfaces().attach(mesh, material, dem::surface_coefficients(options_, material, part_), start);
  }

  Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                     std::span<NodalForces> forces, std::span<ContactSums> contact) override {
    const double dt = duration / substeps;
    if (dt != dt_) set_step(dt);
    dem::SurfaceContacts& surfaces = solver_.surfaces();
    surfaces.set_targets(targets, duration);
    for (int k = 0; k < surfaces.count(); ++k) {
      if (const char* wall = dem::side_crossed(solver_.params().bin, surfaces.swept_bounds(k)))
        return Outcome::failure("is too small", fmt::format("tire {} reached {} of the bin", k, wall));
    }
    if (surfaces.any()) surfaces.restrict_to(grain_box());
    for (int s = 0; s < substeps; ++s) {
      if (each_substep_) each_substep_();
      if (const Outcome outcome = substep(s, substeps); !outcome.ok) return outcome;
    }
    surfaces.move_to(1.0);
    surfaces.finish(duration, forces, contact);
    for (const ContactSums& sums : contact) surface_work_ -= sums.work;
    if (const double met = solver_.accounts().max_overlap; met > dem::stated_overlap(options_))
      stable_overlap_ = std::max(stable_overlap_, met);
    return {};
  }

  TerrainState gather_state() const override {
    const dem::Accounts& a = solver_.accounts();
    const double mass = solver_.params().grain.mass;
    TerrainState s;
    s.kinetic_energy = a.kinetic;
    s.elastic_energy = a.elastic;
    s.floor_force = a.floor_force;
    s.contacts = a.contacts;
    s.active = a.active;
    s.list_rebuilds = std::llround(solver_.rebuilds());
    refinement_.report(s);
    s.energies = solver_.reported_energies();
    s.energies.surface_work = surface_work_;  // walls do not move, so they do no work
    s.momenta = {mass * a.velocity, solver_.gravity_impulse(), a.wall_impulse, a.surface_impulse, -a.momentum_removed};
    return s;
  }

  void set_threads(int threads) override { solver_.set_threads(threads); }
  std::int64_t size() const override { return solver_.grains().count; }

  void gather_frame(TerrainFrame& out) const override {
    const dem::Grains& grains = solver_.grains();
    const std::size_t n = grains.count;
    out.position.resize(3 * n);
    out.speed.resize(n);
    out.radius.resize(n);
    for (auto* of : {&out.velocity, &out.spin}) of->resize(out.motion ? 3 * n : 0);
    const auto put = [](std::vector<float>& to, std::size_t id, const dem::Quad& q) {
      to[3 * id] = static_cast<float>(q.x), to[3 * id + 1] = static_cast<float>(q.y);
      to[3 * id + 2] = static_cast<float>(q.z);
    };
    for (std::size_t g = 0; g < n; ++g) {
      const std::size_t id = grains.id[g];
      const dem::Quad &x = grains.position[g], &v = grains.velocity[g];
      put(out.position, id, x);
      out.radius[id] = static_cast<float>(x.w);
      out.speed[id] = static_cast<float>(std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z));
      if (!out.motion) continue;
      put(out.velocity, id, v);
      put(out.spin, id, grains.spin[g]);
    }
  }

  void save(Archive& archive) const override {
    Archive::Scope scope(archive, "terrain/");
    archive.put("step", dt_);
    archive.put("stable_overlap", stable_overlap_);
    archive.put("surface_work", surface_work_);
    // Saves nothing if refinement was never needed: such a run keeps the state format that it always had.
    refinement_.save(archive);
    solver_.save(archive);
  }

  void do_restore(const Archive& archive) override {
    const Archive::Scope scope(archive, "terrain/");
    dem::require_same_parcels(archive, solver_.strips());
    solver_.restore(archive);
    set_step(archive.get_double("step"));
    stable_overlap_ = archive.get_double("stable_overlap");
    surface_work_ = archive.get_double("surface_work");
    refinement_.restore(archive);
  }

 private:
  std::size_t attached() const override { return solver_.surfaces().count(); }
  std::size_t vertices(std::size_t k) const override { return solver_.surfaces().vertices(static_cast<int>(k)); }

  void set_step(double dt) {
    FURROW_ASSERT(dt > 0.0, dt);
    dt_ = dt;
    refinement_.set_step(dt);
    set_part(dt);
  }

  /// From now on contacts are evaluated for parts of length `dt`.
  void set_part(double dt) {
    FURROW_ASSERT(dt > 0.0 && dt <= dt_, dt, dt_);
    part_ = dt;
    solver_.set_coefficients(dem::run_coefficients(options_, dt));
    for (int k = 0; k < solver_.surfaces().count(); ++k)
      solver_.surfaces().set_coefficients(k,
                                          dem::surface_coefficients(options_, solver_.surfaces().material(k), part_));
  }

  /// One step of dt_, in as many parts as its hardest contact needs.
  Outcome substep(int s, int substeps) {
    constexpr int kWhole = 1 << dem::kFinestLevel;
    int parts = 0;
    for (int done = 0; done < kWhole; ++parts) {
      solver_.surfaces().move_to((s + static_cast<double>(done) / kWhole) / substeps);
      if (Outcome outcome = refinement_.choose(solver_, done == 0); !outcome.ok) return outcome;
      const double dt = std::ldexp(dt_, -refinement_.level());
      if (dt != part_) set_part(dt);
      done += kWhole >> refinement_.level();
      const int lost = solver_.step_part({dt, refinement_.since(), dt_, done == kWhole});
      refinement_.took(dt);
      if (lost >= 0) return lost_grain(lost);
    }
    refinement_.count(parts);
    return {};
  }

  /// Box of all grains now, with a margin for their motion in one interval.
  SurfaceBox grain_box() const {
    const double room = 10.0 * dem::largest_radius(options_);
    return {Vec3(-room, -0.5 * options_.width - room, -room),
            Vec3(options_.length + room, 0.5 * options_.width + room, solver_.top() + room)};
  }

  Outcome lost_grain(int index) const {
    FURROW_ASSERT(in_range(index, solver_.grains().count), index, solver_.grains().count);
    const dem::Quad& x = solver_.grains().position[index];
    return Outcome::failure(
        fmt::format("lost grain {}", solver_.grains().id[index]),
        fmt::format("it left the bin or is not finite, x = ({:.6g}, {:.6g}, {:.6g}) m", x.x, x.y, x.z));
  }

  dem::DemOptions options_;
  std::function<void()> each_substep_;
  dem::GrainSolver solver_;
  dem::StepRefinement refinement_;
  double dt_, part_;             // the step, and the part of it for which contacts are evaluated, s
  double stable_overlap_ = 0.0;  // largest overlap for which the step was checked, m
  double surface_work_ = 0.0;    // by tires on the grains, J
};

}  // namespace

void check_dem_run(const DemOptions& options) {
  check(options);
  const dem::StableStep stable = dem::stable_at(options, dem::stated_overlap(options));
  if (options.step > stable.step && !options.allow_unstable_step)
    throw input_error(options.scenario, "run.step",
                      fmt::format("{} s is above the stable step {:.3g} s ({}); expected a smaller step, "
                                  "more terrain.substeps, or softer grains",
                                  options.step, stable.step, stable.reason));
}

std::unique_ptr<Terrain> make_dem_terrain(const DemOptions& options, std::function<void()> each_substep) {
  check_dem_run(options);
  return std::make_unique<DemTerrain>(options, std::move(each_substep));
}

int useful_threads(int threads, double grains) {
  FURROW_ASSERT(threads > 0, threads);
  return static_cast<int>(std::fmax(1.0, std::fmin(grains / kGrainsOfThread, threads)));
}

TerrainEstimate estimate_dem_terrain(const dem::DemOptions& options) {
  check(options);
  TerrainEstimate e;
  const dem::StableStep stable = dem::stable_at(options, dem::stated_overlap(options));
  e.stable_step = stable.step;
  e.stable_reason = stable.reason;
  const double grains = dem::expected_grains(options);
  if (grains > kMostGrains)
    throw input_error(options.scenario, "terrain.length",
                      fmt::format("gives about {:.2g} grains, expected at most {:g}", grains, kMostGrains));
  e.grains = static_cast<std::int64_t>(std::llround(grains));
  e.memory_bytes = kBytesPerGrain * grains;
  e.frame_bytes = kBytesPerFrameGrain * static_cast<double>(e.grains);
  e.checkpoint_bytes = kBytesPerSavedGrain * static_cast<double>(e.grains);
  const double volume =
      grains * 4.0 / 3.0 * std::numbers::pi * std::pow(options.radius, 3) * dem::mean_volume_ratio(options);
  const double fraction = options.solid_fraction > 0.0 ? options.solid_fraction : kLooseFraction;
  e.expected_height = volume / (fraction * options.length * options.width);
  const std::string sizes =
      options.size_spread > 0.0
          ? fmt::format(" (radii {:.3g} to {:.3g} mm, median by mass {:.3g} mm)", 1e3 * dem::smallest_radius(options),
                        1e3 * dem::largest_radius(options), 1e3 * dem::median_radius_by_mass(options))
          : "";
  e.text =
      fmt::format("about {} grains of radius {:g} mm{}, law {}, bed about {:.0f} mm deep, bin {:g} × {:g} m", e.grains,
                  1e3 * options.radius, sizes, options.law, 1e3 * e.expected_height, options.length, options.width);
  return e;
}

}  // namespace furrow::terrain
