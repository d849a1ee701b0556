#include "terrain/dem/beds/bed_generators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_csv.hpp"
#include "terrain/dem/beds/bed_layers.hpp"
#include "terrain/dem/beds/bed_positions_h5.hpp"
#include "terrain/dem/beds/bed_tiling.hpp"
#include "terrain/dem/close_pairs.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kMinDistance = 1.8;  // mean radii between centres in a user's bed: overlaps of 10 % of the diameter
constexpr double kSingle = 1e-7;      // relative round-off of a float
constexpr double kMinWall = 0.8;      // radii between a centre and a wall
constexpr double kMaxFall = 100.0;    // largest radii from a grain's centre to the next one below
constexpr std::size_t kMaxGrains = 500'000'000;

struct Lattice {
  int nx = 0, ny = 0;
  double dx = 0.0, dy = 0.0;  // m
};

/// Fills the bin evenly, with space for jitter at the walls and for the shift of every other layer. `around`: continues
/// across periodic sides of the bin.
Lattice lattice_of(const Bin& bin, double radius, bool around) {
  const auto along = [&](double size, bool periodic, int& n, double& spacing) {
    const double least = kLatticeSpacing * radius;
    if (around && periodic) {
      n = std::max(1, static_cast<int>(size / least));
      spacing = size / n;
      return;
    }
    const double room = size - 2.0 * (1.0 + kLatticeJitter) * radius;
    n = std::max(1, static_cast<int>(std::floor(room / least + 0.5)));
    spacing = n > 1 ? room / (n - 0.5) : 0.0;
  };
  Lattice lattice;
  along(bin.length, bin.periodic_x, lattice.nx, lattice.dx);
  along(bin.width, bin.periodic_y, lattice.ny, lattice.dy);
  return lattice;
}

std::vector<Quad> lattice_layers(const DemOptions& o, const ProgressCall& progress) {
  std::vector<Quad> all;
  PacedCall tell(progress);
  for (int layer = 0; layer < o.layers; ++layer) {
    tell("placing the grains", static_cast<double>(layer) / o.layers);
    const auto seed = o.seed * 1000003ULL + static_cast<std::uint64_t>(layer);
    for (Quad p : lattice_layer(bin_of(o), largest_radius(o), seed, layer % 2 == 1, o.piece)) {
      p.z = (layer + 0.5) * kSpacing * largest_radius(o);
      all.push_back(p);
    }
  }
  return all;
}

std::vector<Quad> poisson_layers(const DemOptions& o, const ProgressCall& progress) {
  return bed_layers(bin_of(o), largest_radius(o), o.layers, o.seed, progress, o.piece);
}

double lattice_count(const DemOptions& o) {
  const Lattice lattice = lattice_of(bin_of(o), largest_radius(o), o.piece);
  return static_cast<double>(o.layers) * lattice.nx * lattice.ny;
}

double poisson_count(const DemOptions& o) {
  return o.layers * expected_layer_count(bin_of(o), largest_radius(o), o.piece);
}

struct Generator {
  const char* name;
  std::vector<Quad> (*make)(const DemOptions&, const ProgressCall&);
  double (*count)(const DemOptions&);
};
constexpr std::array<Generator, 2> kGenerators{
    {{"poisson", poisson_layers, poisson_count}, {"lattice", lattice_layers, lattice_count}}};

const Generator& generator_of(const DemOptions& o) {
  std::string names;
  for (const Generator& g : kGenerators) {
    if (o.bed_generator == g.name) return g;
    names += (names.empty() ? "" : " or ") + std::string(g.name);
  }
  throw input_error(o.scenario, "terrain.bed_generator", "'" + o.bed_generator + "' is unknown, expected " + names);
}

std::string place_text(const Quad& p) { return fmt::format("({:g}, {:g}, {:g}) m", p.x, p.y, p.z); }

/// The first grain without support, and its height.
struct Hanging {
  std::size_t grain = 0;
  double height = 0.0;  // above the next one below it, or above the floor, m
};
std::optional<Hanging> find_hanging(const std::vector<Quad>& grains, double most) {
  std::vector<std::size_t> order(grains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(grains[a].z, a) < std::pair(grains[b].z, b); });
  double below = 0.0;
  for (const std::size_t g : order) {
    if (grains[g].z - below > most) return Hanging{g, grains[g].z - below};
    below = grains[g].z;
  }
  return {};
}

std::vector<Quad> positions_of(const DemOptions& o, const ProgressCall& progress = {}) {
  std::vector<Quad> grains = is_hdf5(o.bed) ? read_positions_h5(o.bed) : read_positions_csv(o.bed, progress);
  check_positions(o, o.bed, grains, progress);
  return grains;
}

}  // namespace

void check_positions(const DemOptions& o, const std::filesystem::path& file, std::vector<Quad>& grains,
                     const ProgressCall& progress) {
  const bool hdf5 = is_hdf5(file);
  const Bin bin = bin_of(o);
  const auto wrong = [&](std::size_t g, const std::string& what) {
    return input_error(file.string(), hdf5 ? fmt::format("grain {}", g) : fmt::format("line {}", g + 2), what);
  };
  if (grains.size() > kMaxGrains)
    throw input_error(file.string(), "",
                      fmt::format("holds {} grains, expected at most {}", grains.size(), kMaxGrains));
  for (std::size_t g = 0; g < grains.size(); ++g) {
    double& radius = grains[g].w;
    if (radius == 0.0 && smallest_radius(o) < largest_radius(o))
      throw wrong(g,
                  "the grain has no radius, expected one (radius_m, or the dataset radius), or terrain.size_spread 0");
    if (radius == 0.0) radius = o.radius;
    // Frames store radii in single precision.
    for (const double limit : {smallest_radius(o), largest_radius(o)})
      if (std::abs(radius - limit) < kSingle * limit) radius = limit;
    if (!(radius >= smallest_radius(o) && radius <= largest_radius(o)))
      throw wrong(g, fmt::format("the grain's radius is {:g} m, expected {:g} to {:g} m: terrain.radius and "
                                 "terrain.size_spread of the scenario",
                                 radius, smallest_radius(o), largest_radius(o)));
    const double least = kMinWall * radius * (1.0 - 1e-9);
    const auto& p = grains[g];
    if ((o.periodic_x && !(p.x >= 0.0 && p.x <= o.length)) || (o.periodic_y() && !(std::abs(p.y) <= 0.5 * o.width)))
      throw wrong(g, fmt::format("the grain stands at {}, expected x 0 to {:g} m, y {:g} to {:g} m", place_text(p),
                                 o.length, -0.5 * o.width, 0.5 * o.width));
    for (int wall = 0; wall < kWalls; ++wall)
      if (bin.has_wall(wall) && !(bin.distance(wall, grains[g]) >= least))
        throw wrong(
            g, fmt::format("the grain stands at {}, expected a centre inside the bin, x {:g} to {:g} m, y {:g} to "
                           "{:g} m, z from {:g} m",
                           place_text(grains[g]), least, o.length - least, least - 0.5 * o.width, 0.5 * o.width - least,
                           least));
  }
  const double fall = kMaxFall * largest_radius(o);
  if (const std::optional<Hanging> hanging = find_hanging(grains, fall))
    throw wrong(
        hanging->grain,
        fmt::format("the grain stands at {}, {:.4g} m above all that is below it, expected at most {:g} m, {:g} "
                    "radii: it would fall too fast to be at rest as a bed",
                    place_text(grains[hanging->grain]), hanging->height, fall, kMaxFall));
  const double reach = kMinDistance * largest_radius(o);
  const auto check_pair = [&](std::size_t a, std::size_t b, double distance) {
    const double mean = 0.5 * (grains[a].w + grains[b].w), least = kMinDistance * mean;
    if (distance >= least) return;
    throw wrong(std::max(a, b),
                fmt::format("the grain at {} is {:.3g} m from that {} {}, expected at "
                            "least {:g} m for grains of radius {:g} m",
                            place_text(grains[std::max(a, b)]), distance, hdf5 ? "of number" : "of line",
                            std::min(a, b) + (hdf5 ? 0 : 2), least, mean));
  };
  for_close_pairs(grains, bin, reach, check_pair, progress);
}

std::vector<Quad> lattice_layer(const Bin& bin, double radius, std::uint64_t seed, bool shifted, bool around) {
  const Lattice lattice = lattice_of(bin, radius, around);
  std::mt19937_64 bits(seed);
  const auto jitter = [&] {
    return kLatticeJitter * radius * (2.0 * static_cast<double>(bits() >> 11) * 0x1p-53 - 1.0);
  };
  const auto edge = [&](bool periodic) { return around && periodic ? 0.0 : (1.0 + kLatticeJitter) * radius; };
  const double edge_x = edge(bin.periodic_x), edge_y = edge(bin.periodic_y), shift = shifted ? 0.5 : 0.0;
  std::vector<Quad> grains;
  for (int ix = 0; ix < lattice.nx; ++ix)
    for (int iy = 0; iy < lattice.ny; ++iy) {
      const double x = edge_x + (ix + shift) * lattice.dx + jitter();
      const double y = edge_y + (iy + shift) * lattice.dy + jitter();
      grains.push_back({x, y - 0.5 * bin.width, 0.0, 0.0});
      if (around) bin.wrap(grains.back());
    }
  return grains;
}

bool is_positions_file(const std::filesystem::path& bed) {
  return is_hdf5(bed) ? !may_be_bed(bed) : bed.extension() != ".h5";
}

std::vector<Quad> starting_positions(const DemOptions& options, const ProgressCall& progress) {
  if (!options.bed.empty()) return positions_of(options, progress);
  std::vector<Quad> grains = generator_of(options).make(options, progress);
  draw_radii(options, grains);
  return grains;
}

double expected_grains(const DemOptions& options) {
  if (!options.bed.empty() && is_positions_file(options.bed)) return static_cast<double>(positions_of(options).size());
  if (is_tiled(options)) return expected_tiled_grains(options, generator_of(options).count(piece_of(options)));
  return generator_of(options).count(options);
}

}  // namespace furrow::terrain::dem
