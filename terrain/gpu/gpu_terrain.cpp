#include "terrain/gpu/gpu_terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/accounts/energy_accounts.hpp"
#include "terrain/dem/beds/bed_height.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/refinement/step_refinement.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/dem/tires/bin_sides.hpp"
#include "terrain/dem/tires/surface_start.hpp"
#include "terrain/gpu/bed_transfer.hpp"
#include "terrain/gpu/saved_state.hpp"
#include "terrain/gpu/tire_on_gpu.hpp"
#include "terrain/surface/surface_check.hpp"

namespace furrow::terrain {
namespace {

using namespace gpu;

constexpr int kMostTires = 16;  // the GPU names a tire in four bits
// Of the device, for each grain: its state and list twice, with room for 16 neighbours and their springs.
constexpr double kBytesPerGrain = 1400.0, kBytesPerRollingGrain = 1900.0;

dem::SolverParams gpu_params(const dem::DemOptions& options) {
  dem::SolverParams p = dem::solver_params(options);
  p.activity = false;
  return p;
}

class GpuTerrain final : public Terrain {
 public:
  explicit GpuTerrain(const dem::DemOptions& options)
      : options_(options), params_(gpu_params(options)), refinement_(options), dt_(options.step), part_(options.step) {
    gpu_device();  // the error if there is none
    refinement_.set_step(dt_);
    start();  // a run that is resumed attaches its tires before it restores the grains
  }

  double do_prepare(const ProgressCall& progress) override {
    const double begin = wall_clock();
    dem::GrainSolver solver(params_);
    solver.set_coefficients(dem::run_coefficients(options_, dt_));
    const dem::PreparedBed prepared = dem::load_bed(solver, dem::level(options_), progress);
    send_bed(solver, *grains_);
    now_ = grains_->sums(false, dt_);
    energies_.begin({{now_.cohesion, now_.tangential}}, 0.0);
    if (progress && !prepared.settled.settled) progress("bed not settled", 1.0);
    return wall_clock() - begin;
  }

  double gather_top_height(double x_min, double x_max, double y_min, double y_max) const override {
    FURROW_ASSERT(x_min <= x_max && y_min <= y_max, x_min, x_max, y_min, y_max);
    return dem::top_height(positions(), x_min, x_max, y_min, y_max);
  }
  double gather_mean_height(double x_min, double x_max, double y_min, double y_max) const override {
    return dem::mean_height(gather_height_field(), x_min, x_max, y_min, y_max);
  }
  double floor_height() const override { return 0.0; }
  HeightField gather_height_field() const override {
    return dem::bed_height_field(positions(), params_.bin, 2.0 * options_.radius);
  }

  void do_attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& begin) override {
    dem::check_surface_start(options_, params_.bin, material, begin, static_cast<int>(tires_.size()));
    add_tire(mesh, material, begin, SurfacePatches(mesh, begin.position, options_.radius));
  }

  Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                     std::span<NodalForces> forces, std::span<ContactSums> contact) override {
    if (const double dt = duration / substeps; dt != dt_) {
      dt_ = dt;
      refinement_.set_step(dt);
      set_part(dt);
    }
    for (std::size_t k = 0; k < tires_.size(); ++k) {
      tires_[k].set_target(targets[k], duration);
      if (const char* wall = dem::side_crossed(params_.bin, tires_[k].swept_box()))
        return Outcome::failure("is too small", fmt::format("tire {} reached {} of the bin", k, wall));
    }
    send_motion();
    if (const Outcome outcome = step(substeps); !outcome.ok) return outcome;
    grains_->move_surfaces(1.0);
    for (std::size_t k = 0; k < tires_.size(); ++k) {
      tires_[k].finish(*grains_, forces[k], contact[k]);
      surface_work_ -= contact[k].work;
      surface_impulse_ -= duration * contact[k].force;
    }
    wall_impulse_ += grains_->wall_impulse();
    now_ = grains_->sums(false, dt_);
    return {};
  }

  TerrainState gather_state() const override {
    const double mass = options_mass(), inertia = params_.grain.inertia;
    TerrainState s;
    TerrainEnergies& e = s.energies;
    e.kinetic = 0.5 * mass * now_.speed2;
    e.rotational = 0.5 * inertia * now_.spin2;
    s.kinetic_energy = e.kinetic + e.rotational;
    s.elastic_energy = now_.elastic;
    s.floor_force = now_.floor_force;
    s.contacts = std::llround(now_.contacts);
    s.active = size();
    s.list_rebuilds = now_.rebuilds;
    refinement_.report(s);
    e.potential = -mass * params_.gravity.dot(vec(now_.place));  // Σ m |g| h = −g·Σ m x
    e.elastic_normal = now_.elastic - energies_.state().stored.cohesion;
    e.elastic_tangential = energies_.state().stored.tangential;
    e.cohesion = energies_.state().stored.cohesion;
    const dem::Losses lost = energies_.lost();
    e.sliding_loss = lost.sliding;
    e.normal_damping_loss = lost.normal_damping;
    e.tangential_damping_loss = lost.tangential_damping;
    e.rolling_loss = lost.rolling;
    e.opening_loss = lost.opening;
    e.sample_error = energies_.error();
    e.surface_work = surface_work_;
    const Vec3 weight = energies_.state().time * mass * static_cast<double>(size()) * params_.gravity;
    s.momenta = {mass * vec(now_.speed), weight, wall_impulse_, surface_impulse_, Vec3::Zero()};
    return s;
  }

  void gather_frame(TerrainFrame& out) const override {
    const GrainMotion g = grains_->motion(true);
    const std::size_t n = g.position.size();
    out.position.resize(3 * n), out.speed.resize(n);
    out.radius.assign(n, static_cast<float>(options_.radius));
    for (auto* of : {&out.velocity, &out.spin}) of->resize(out.motion ? 3 * n : 0);
    const auto put = [](std::vector<float>& to, std::size_t id, const Vec3& v) {
      for (int k = 0; k < 3; ++k) to[3 * id + k] = static_cast<float>(v[k]);
    };
    for (std::size_t id = 0; id < n; ++id) {
      put(out.position, id, g.position[id]);
      out.speed[id] = static_cast<float>(g.velocity[id].norm());
      if (out.motion) put(out.velocity, id, g.velocity[id]), put(out.spin, id, g.spin[id]);
    }
  }

  std::int64_t size() const override { return grains_->count(); }

  void save(Archive& archive) const override {
    const Archive::Scope scope(archive, "terrain/");
    archive.put("step", dt_);
    archive.put("surface_work", surface_work_);
    save_value(archive, "wall_impulse", wall_impulse_);
    save_value(archive, "surface_impulse", surface_impulse_);
    archive.put("floor_force", now_.floor_force);
    refinement_.save(archive);
    energies_.save(archive);
    save_grains(grains_->motion(true), grains_->histories(), archive);
    archive.put("surfaces/count", static_cast<std::int64_t>(tires_.size()));
    for (std::size_t k = 0; k < tires_.size(); ++k) {
      const Archive::Scope of_tire(archive, fmt::format("surface{}/", k));
      save_fields(archive, "mesh", tires_[k].mesh());
      save_value(archive, "position", tires_[k].position());
      save_fields(archive, "material", tires_[k].material());
      save_fields(archive, "patches", tires_[k].patches());
    }
  }

  void do_restore(const Archive& archive) override {
    const Archive::Scope scope(archive, "terrain/");
    const SavedGrains saved = read_grains(archive);
    dt_ = part_ = archive.get_double("step");
    surface_work_ = archive.get_double("surface_work");
    restore_value(archive, "wall_impulse", wall_impulse_);
    restore_value(archive, "surface_impulse", surface_impulse_);
    refinement_.set_step(dt_);
    refinement_.restore(archive);
    energies_.restore(archive, 1);
    const auto count = archive.get_int("surfaces/count");
    if (count < 0 || (!tires_.empty() && static_cast<std::size_t>(count) != tires_.size()))
      throw Error(ExitCode::io, fmt::format("saved state holds {} surfaces, expected {}", count, tires_.size()));
    const std::vector<TireOnGpu> before = std::exchange(tires_, {});
    start();
    grains_->place(saved.motion);
    for (std::int64_t k = 0; k < count; ++k) {
      const Archive::Scope of_tire(archive, fmt::format("surface{}/", k));
      SurfaceMesh mesh;
      SurfaceState begin;
      ContactMaterial material;
      SurfacePatches patches;
      restore_fields(archive, "mesh", mesh);
      restore_value(archive, "position", begin.position, mesh.vertex_count);
      restore_fields(archive, "material", material);
      restore_fields(archive, "patches", patches);
      check_surface(mesh, begin, static_cast<int>(k));
      if (!before.empty() && begin.position.size() != before[k].vertices())
        throw Error(ExitCode::io, fmt::format("saved state of surface {} is of another tire", k));
      add_tire(mesh, material, begin, std::move(patches));
    }
    grains_->remember(saved.histories);
    now_ = grains_->sums(false, dt_);
    // The grains near each tire, and the tire's planes, as at the end of the saved interval.
    for (TireOnGpu& tire : tires_)
      tire.set_target({tire.position(), std::vector<Vec3>(tire.vertices(), Vec3::Zero())}, dt_);
    send_motion();
    grains_->move_surfaces(1.0);
    now_ = grains_->sums(false, dt_);
    now_.floor_force = archive.get_double("floor_force");
  }

 private:
  std::size_t attached() const override { return tires_.size(); }
  std::size_t vertices(std::size_t k) const override { return tires_[k].vertices(); }

  static Vec3 vec(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
  double options_mass() const { return params_.grain.mass; }

  void start() {
    grains_ = std::make_unique<GpuGrains>(params_);
    grains_->set_coefficients(dem::run_coefficients(options_, part_));
    unknown_ = true;
  }

  void add_tire(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& begin,
                SurfacePatches patches) {
    if (tires_.size() == kMostTires)
      throw input_error(options_.scenario, "terrain.device", "is 'gpu', which takes {} tires at most", kMostTires);
    const int k = static_cast<int>(tires_.size());
    tires_.emplace_back(*grains_, k, mesh, material, begin, options_.radius, std::move(patches));
    set_tire_coefficients(k);
  }
  void set_tire_coefficients(int k) {
    const dem::ContactCoefficients c = dem::surface_coefficients(options_, tires_[k].material(), part_);
    const bool rolls = dem::with_law(params_.law, [&](auto law) { return c.of<decltype(law)>().rolling_arm > 0.0; });
    if (rolls && !params_.rolling)
      throw input_error(options_.scenario, "terrain.device",
                        "is 'gpu', where a tire resists rolling only if grains do; expected rolling_friction above 0");
    grains_->set_surface_coefficients(k, c, rolls);
  }
  /// From now on contacts are evaluated for parts of length `dt`.
  void set_part(double dt) {
    part_ = dt;
    grains_->set_coefficients(dem::run_coefficients(options_, dt));
    for (int k = 0; k < static_cast<int>(tires_.size()); ++k) set_tire_coefficients(k);
  }

  void send_motion() {
    const double room = 10.0 * options_.radius;
    const SurfaceBox box{Vec3(-room, -0.5 * options_.width - room, -room),
                         Vec3(options_.length + room, 0.5 * options_.width + room, now_.top + room)};
    for (TireOnGpu& tire : tires_) tire.send(*grains_, box);
  }

  /// All steps of an interval: together while the contacts allow it, else one by one, in parts.
  Outcome step(int substeps) {
    for (int s = 0; s < substeps;) {
      if (energies_.due()) sample(static_cast<double>(s) / substeps);
      if (refinement_.level() > 0 || refinement_.since() != dt_ || may_be_deep()) {
        if (Outcome outcome = step_in_parts(s++, substeps); !outcome.ok) return outcome;
        continue;
      }
      const std::int64_t until = energies_.state().until;
      const int most = static_cast<int>(
          std::min<std::int64_t>(substeps - s, until == 0 ? std::int64_t{dem::kLossSampleSteps} : until));
      const RunResult did =
          run({most, dt_, dt_, static_cast<double>(s) / substeps, 1.0 / substeps, refinement_.watched(), 0.0});
      for (int k = 0; k < did.done; ++k) energies_.advance(dt_, true, 0.0), refinement_.count(1);
      s += did.done;
      if (did.stop == Stop::lost) return lost_grain(did.lost);
    }
    return {};
  }

  /// One step of dt_, in as many parts as its hardest contact needs.
  Outcome step_in_parts(int s, int substeps) {
    constexpr int kWhole = 1 << dem::kFinestLevel;
    int parts = 0;
    for (int done = 0; done < kWhole; ++parts) {
      const double share = (s + static_cast<double>(done) / kWhole) / substeps;
      grains_->move_surfaces(share);
      const auto find = [&](double above, double ahead) { return hard_contacts(above, ahead); };
      if (Outcome outcome = refinement_.choose(find, done == 0); !outcome.ok) return outcome;
      const double dt = std::ldexp(dt_, -refinement_.level()), since = refinement_.since();
      if (dt != part_) set_part(dt);
      done += kWhole >> refinement_.level();
      const RunResult did = run({1, dt, since, share, 0.0, std::numeric_limits<double>::infinity(), 0.0});
      energies_.advance(0.5 * (since + dt), done == kWhole, 0.0);
      refinement_.took(dt);
      if (did.stop == Stop::lost) return lost_grain(did.lost);
    }
    refinement_.count(parts);
    return {};
  }

  RunResult run(const Run& what) {
    const RunResult did = grains_->run(what);
    last_overlap_ = did.last_overlap, last_speed_ = did.last_speed;
    unknown_ = false;
    return did;
  }

  /// Whether a contact may overlap by more than what is watched, as GrainSolver::may_overlap.
  bool may_be_deep() const {
    const double watched = refinement_.watched();
    if (watched == std::numeric_limits<double>::infinity()) return false;
    double fastest = last_speed_;
    for (const TireOnGpu& tire : tires_) fastest = std::max(fastest, tire.fastest());
    return unknown_ || !(last_overlap_ + dt_ * (last_speed_ + fastest) <= watched);
  }

  dem::HardContacts hard_contacts(double above, double ahead) {
    if (above == std::numeric_limits<double>::infinity()) return {};
    const Hardest found = grains_->hardest(above, ahead);
    dem::HardContacts hard;
    hard.count = found.count, hard.past = found.past;
    hard.overlap = found.overlap, hard.coming = found.coming, hard.share = found.share;
    hard.deepest = 2.0 * options_.radius * found.share;
    if (found.past == 0) return hard;
    hard.at = grains_->motion(false).position.at(found.grain);
    hard.between = found.kind == 0   ? "two grains"
                   : found.kind == 1 ? std::string("a grain and ") + dem::Bin::name(found.partner)
                                     : fmt::format("a grain and tire {}", found.partner);
    return hard;
  }

  /// Samples the losses of the coming step.
  void sample(double share) {
    grains_->move_surfaces(share);
    const Sums s = grains_->sums(true, refinement_.since());
    const dem::ContactSample one{{s.losses[0], s.losses[1], s.losses[2], s.losses[3], s.losses[4]},
                                 {s.cohesion, s.tangential}};
    energies_.sample(1, [&](int) { return &one; });
  }

  Outcome lost_grain(int id) const {
    const Vec3 x = grains_->motion(false).position.at(id);
    return Outcome::failure(
        fmt::format("lost grain {}", id),
        fmt::format("it left the bin or is not finite, x = ({:.6g}, {:.6g}, {:.6g}) m", x.x(), x.y(), x.z()));
  }

  dem::Grains positions() const {
    const GrainMotion g = grains_->motion(false);
    dem::Grains out;
    out.resize(static_cast<int>(g.position.size()));
    for (std::size_t k = 0; k < g.position.size(); ++k)
      out.position[k] = {g.position[k].x(), g.position[k].y(), g.position[k].z(), options_.radius};
    return out;
  }

  dem::DemOptions options_;
  dem::SolverParams params_;
  dem::StepRefinement refinement_;
  dem::EnergyAccounts energies_;
  std::unique_ptr<GpuGrains> grains_;
  std::vector<TireOnGpu> tires_;
  Sums now_{};                                    // at the end of the last interval
  double dt_, part_;                              // the step, and the part of it for which contacts are evaluated, s
  bool unknown_ = true;                           // no step was taken yet
  double last_overlap_ = 0.0, last_speed_ = 0.0;  // largest of the last step, m, m/s
  double surface_work_ = 0.0;                     // by tires on the grains, J
  Vec3 wall_impulse_ = Vec3::Zero(), surface_impulse_ = Vec3::Zero();  // on the grains, N s
};

}  // namespace

void check_gpu_options(const dem::DemOptions& o) {
  const auto refuse = [&](const char* key, const std::string& is, const char* expected) {
    return input_error(o.scenario, key, "is {} with terrain.device 'gpu', expected {}", is, expected);
  };
  if (o.size_spread > 0.0) throw refuse("terrain.size_spread", fmt::format("{:g}", o.size_spread), "0");
  if (o.precision != "mixed") throw refuse("terrain.precision", "'" + o.precision + "'", "'mixed'");
  if (o.contact_tangents) throw refuse("tire.contact_tangent", "true", "false");
}

std::unique_ptr<Terrain> make_gpu_terrain(const dem::DemOptions& options) {
  check_gpu_options(options);
  return std::make_unique<GpuTerrain>(options);
}

std::string gpu_text(const dem::DemOptions& options, double grains) {
  const DeviceInfo info = gpu_device();
  const double needs = (options.rolling_friction > 0.0 ? kBytesPerRollingGrain : kBytesPerGrain) * grains;
  if (info.emulated) return fmt::format("{}; the bed needs about {:.2g} GB", info.name, 1e-9 * needs);
  const auto version = [](int v) { return fmt::format("{}.{}", v / 1000, v % 1000 / 10); };
  return fmt::format("{}, driver for CUDA {}, {:.0f} GB, of which the bed needs about {:.2g}", info.name,
                     version(info.driver), 1e-9 * static_cast<double>(info.memory), 1e-9 * needs);
}

Archive gpu_state_as_solver_state(const Archive& state, const dem::DemOptions& options) {
  SavedGrains saved;
  {
    const Archive::Scope scope(state, "terrain/");
    saved = read_grains(state);
  }
  dem::GrainSolver solver(dem::solver_params(options));
  set_bed(saved.motion, saved.histories, solver);
  Archive archive;
  const Archive::Scope scope(archive, "terrain/");
  solver.save(archive);
  return archive;
}

}  // namespace furrow::terrain
