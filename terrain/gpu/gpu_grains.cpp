#include "terrain/gpu/gpu_grains.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/refinement/hard_contacts.hpp"
#include "terrain/plugin_file.hpp"

namespace furrow::terrain::gpu {
namespace {

constexpr char kFile[] = "libfurrow_gpu.so";
constexpr char kKey[] = "terrain.device";

static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// The library's functions, or why there are none.
struct Library {
  const Api* api = nullptr;
  std::string problem;

  Library() {
    if (problem = gpu_library_problem(); !problem.empty()) return;
    std::string why;
    void* const opened = open_plugin(find_plugin(kFile), why);
    void* const symbol = opened ? find_symbol(opened, kApiSymbol) : nullptr;
    if (!symbol) {
      problem =
          fmt::format("is 'gpu', but {} cannot be loaded: {}", kFile, why.empty() ? "it is another library" : why);
      return;
    }
    const Api* const found = reinterpret_cast<GetApi>(symbol)();
    if (found->abi != kAbi) {
      problem = fmt::format("is 'gpu', but {} is of version {}, expected {}", kFile, found->abi, kAbi);
      return;
    }
    api = found;
  }
};

const Library& library() {
  static const Library one;
  return one;
}

const Api& api() {
  if (!library().api) throw input_error("scenario", kKey, library().problem);
  return *library().api;
}

void check(Status status, const Why& why) {
  switch (status) {
    case Status::done:
      return;
    case Status::no_device:
      throw input_error("scenario", kKey, "is 'gpu', but {}; expected 'cpu', or an NVIDIA driver and GPU", why.text);
    case Status::memory:
      throw limit_error(fmt::format("the GPU ran out of memory: {}; expected fewer grains or another GPU", why.text));
    case Status::failed:
      throw Error(ExitCode::rank_lost, fmt::format("the GPU failed: {}", why.text));
    case Status::fault:
      break;
  }
  throw fault_error(std::string(kFile) + ": " + why.text);
}

/// Calls a function of the library with `arguments` and a place for its complaint.
template <class F, class... Arguments>
void call(F function, Arguments... arguments) {
  Why why{};
  check(function(arguments..., &why), why);
}

auto rows(std::span<const Vec3> v) { return reinterpret_cast<const double(*)[3]>(v.data()); }
auto rows(std::span<Vec3> v) { return reinterpret_cast<double(*)[3]>(v.data()); }

Setup setup_of(const dem::SolverParams& p, int order) {
  Setup s{};
  s.length = p.bin.length, s.width = p.bin.width;
  s.periodic_x = p.bin.periodic_x, s.periodic_y = p.bin.periodic_y;
  s.radius = p.grain.radius, s.mass = p.grain.mass, s.inertia = p.grain.inertia;
  for (int k = 0; k < 3; ++k) s.gravity[k] = p.gravity[k];
  s.skin = p.skin;
  s.law = static_cast<int>(p.law);
  s.rolling = p.rolling;
  s.order = order;
  return s;
}

}  // namespace

std::string gpu_library_problem() {
  const std::filesystem::path file = find_plugin(kFile);
  if (file.empty())
    return fmt::format(
        "is 'gpu', but {} is not beside this program; expected 'cpu', or a program built where CUDA 12.4 or later is "
        "installed",
        kFile);
  const std::string problem = plugin_problem(file);
  return problem.empty() ? "" : "is 'gpu', but " + problem;
}

DeviceInfo gpu_device() {
  DeviceInfo info{};
  call(api().device, &info);
  return info;
}

void GpuGrains::Destroy::operator()(Engine* engine) const { library().api->destroy(engine); }

GpuGrains::GpuGrains(const dem::SolverParams& params, int order) {
  const Setup setup = setup_of(params, order);
  Engine* made = nullptr;
  call(api().make, &setup, &made);
  engine_.reset(made);
}

void GpuGrains::place(const GrainMotion& g) {
  FURROW_ASSERT(g.velocity.size() == g.position.size() && g.spin.size() == g.position.size(), g.position.size());
  count_ = static_cast<int>(g.position.size());
  call(api().place, engine_.get(), count_, rows(g.position), rows(g.velocity), rows(g.spin));
}

void GpuGrains::remember(const Histories& h) {
  const auto size = [](const auto& v) { return static_cast<std::int64_t>(v.size()); };
  call(api().remember, engine_.get(), size(h.pairs), h.pairs.data(), size(h.walls), h.walls.data(), size(h.facets),
       h.facets.data());
}

void GpuGrains::set_coefficients(const dem::SolverCoefficients& c) {
  call(api().coefficients, engine_.get(), &c.pair, &c.floor, &c.side);
}

void GpuGrains::attach(const Surface& surface) { call(api().attach, engine_.get(), &surface); }

void GpuGrains::set_surface_coefficients(int k, const dem::ContactCoefficients& c, bool rolls) {
  call(api().surface_coefficients, engine_.get(), k, &c, static_cast<std::int32_t>(rolls));
}

void GpuGrains::set_surface_motion(int k, std::span<const Vec3> end, double duration, const FacetGrid& grid,
                                   bool same_grid) {
  call(api().surface_motion, engine_.get(), k, rows(end), duration, &grid, static_cast<std::int32_t>(same_grid));
}

void GpuGrains::move_surfaces(double share) { call(api().move_surfaces, engine_.get(), share); }

SurfaceSums GpuGrains::surface_result(int k, std::span<Vec3> impulse) {
  SurfaceSums sums{};
  call(api().surface_result, engine_.get(), k, rows(impulse), &sums);
  return sums;
}

RunResult GpuGrains::run(const Run& run) {
  RunResult result{};
  call(api().run, engine_.get(), &run, &result);
  return result;
}

Hardest GpuGrains::hardest(double above, double ahead) {
  Hardest found{};
  call(api().hardest, engine_.get(), above, ahead, dem::kDeepestShare, &found);
  return found;
}

Sums GpuGrains::sums(bool losses, double dt) {
  Sums sums{};
  call(api().sums, engine_.get(), static_cast<std::int32_t>(losses), dt, &sums);
  return sums;
}

Vec3 GpuGrains::wall_impulse() {
  Vec3 impulse = Vec3::Zero();
  call(api().wall_impulse, engine_.get(), impulse.data());
  return impulse;
}

GrainMotion GpuGrains::motion(bool all) const {
  GrainMotion g;
  g.position.resize(count_);
  g.velocity.resize(all ? count_ : 0), g.spin.resize(all ? count_ : 0);
  call(api().motion, engine_.get(), rows(std::span(g.position)), all ? rows(std::span(g.velocity)) : nullptr,
       all ? rows(std::span(g.spin)) : nullptr);
  return g;
}

Histories GpuGrains::histories() const {
  std::int64_t pairs = 0, walls = 0, facets = 0;
  const Pair* pair = nullptr;
  const WallTouch* wall = nullptr;
  const FacetTouch* facet = nullptr;
  call(api().histories, engine_.get(), &pairs, &pair, &walls, &wall, &facets, &facet);
  return {{pair, pair + pairs}, {wall, wall + walls}, {facet, facet + facets}};
}

}  // namespace furrow::terrain::gpu
