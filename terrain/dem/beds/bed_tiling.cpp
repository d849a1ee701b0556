#include "terrain/dem/beds/bed_tiling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_seams.hpp"
#include "terrain/dem/close_pairs.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr const char* kJoining = "joining the pieces of the bed";

/// Grains of one column from x = `from` − band to x = `to` + band, before its seams are made.
struct Column {
  double from = 0.0, to = 0.0;  // m
  std::vector<Quad> grains;
  std::vector<bool> stays;
};

/// Position of the piece's grain p in column `number`, relative to the column's beginning and the middle of the piece.
Quad moved(Quad p, const Tiling& tiling, const Bin& of_piece, int number) {
  if (number % 2 == 1) p.x = tiling.length - p.x;
  if (number % 4 == 1 || number % 4 == 2) p.y = -p.y;
  if (of_piece.periodic_y) p.y += tiling.width * std::fmod(number * (std::numbers::phi - 1.0), 1.0);
  of_piece.wrap(p);
  return p;
}

/// Whether a grain does not touch those walls of the bin that the piece does not have.
bool free_of_walls(const Quad& p, const Bin& bin, const Bin& of_piece) {
  for (int wall = 0; wall < kFloor; ++wall)
    if (bin.has_wall(wall) && !of_piece.has_wall(wall) && bin.distance(wall, p) < p.w) return false;
  return true;
}

Column column_of(const std::vector<Quad>& piece, const DemOptions& o, const Tiling& tiling, int number) {
  Column column;
  column.from = number * tiling.length;
  column.to = number + 1 == tiling.along ? o.length : (number + 1) * tiling.length;
  const double band = kSeamBand * largest_radius(o);
  const Bin bin = bin_of(o), of_piece = bin_of(piece_of(o));
  for (int across = 0; across < tiling.across; ++across)
    for (const Quad& grain : piece) {
      Quad p = moved(grain, tiling, of_piece, number);
      p.y += (across + 0.5) * tiling.width - 0.5 * o.width;
      // Along x the column continues beyond its ends, like the piece.
      for (const double image : {-tiling.length, 0.0, tiling.length}) {
        Quad at = p;
        at.x += column.from + image;
        if (at.x < column.from - band || at.x >= column.to + band) continue;
        if (free_of_walls(at, bin, of_piece)) column.grains.push_back(at);
      }
    }
  column.stays.assign(column.grains.size(), true);
  return column;
}

/// Largest overlap of two grains, relative to the sum of their radii.
double largest_overlap(const std::vector<Quad>& piece, const DemOptions& of_piece, const ProgressCall& progress) {
  double largest = 0.0;
  const auto pair = [&](std::size_t a, std::size_t b, double distance) {
    largest = std::max(largest, 1.0 - distance / (piece[a].w + piece[b].w));
  };
  for_close_pairs(piece, bin_of(of_piece), 2.0 * largest_radius(of_piece), pair, progress);
  return largest;
}

/// Indices of a column's grains with x in [from, to).
std::vector<int> between(const Column& column, double from, double to) {
  std::vector<int> found;
  for (std::size_t g = 0; g < column.grains.size(); ++g)
    if (column.grains[g].x >= from && column.grains[g].x < to) found.push_back(static_cast<int>(g));
  return found;
}

/// Grains of two columns around their seam, in one list: first those of `before`, then those of `after`.
struct SeamGrains {
  std::vector<int> before, after;  // indices in their columns
  std::vector<Quad> points;        // relative to the beginning of a bin of its own
  Bin bin;
};

SeamGrains grains_at(double seam, double band, double reach, const Column& before, const Column& after,
                     const DemOptions& o) {
  SeamGrains s;
  // Beyond the band there is only one column: its grains stay, and those of the other must not collide with them.
  s.before = between(before, seam - band - reach, seam + band);
  s.after = between(after, seam - band, seam + band + reach);
  const double origin = seam - band - reach;
  const auto add = [&](const Column& column, const std::vector<int>& grains) {
    for (const int g : grains) {
      s.points.push_back(column.grains[g]);
      s.points.back().x -= origin;
    }
  };
  add(before, s.before);
  add(after, s.after);
  s.bin = {2.0 * (band + reach), o.width, false, o.periodic_y()};
  return s;
}

/// Decides which grains of two neighbouring columns stay around the seam between them.
void join(Column& before, Column& after, double overlap, const DemOptions& o, const ProgressCall& progress) {
  const double seam = after.from, band = kSeamBand * largest_radius(o), reach = 2.0 * largest_radius(o);
  const SeamGrains s = grains_at(seam, band, reach, before, after, o);
  const auto firsts = static_cast<int>(s.before.size()), seconds = static_cast<int>(s.after.size());
  const auto fixed = [&](std::size_t g) {
    const double x = s.points[g].x - reach;  // distance from the beginning of the band
    return x < 0.0 || x >= 2.0 * band;
  };
  Conflicts conflicts(firsts);
  std::vector<bool> barred(s.points.size(), false);
  const auto pair = [&](std::size_t a, std::size_t b, double distance) {
    if (static_cast<int>(a) >= firsts || static_cast<int>(b) < firsts) return;  // both are of one column
    if (distance >= (1.0 - overlap) * (s.points[a].w + s.points[b].w)) return;
    if (fixed(a)) barred[b] = true;
    if (fixed(b)) barred[a] = true;
    conflicts[a].push_back(static_cast<int>(b) - firsts);
  };
  for_close_pairs(s.points, s.bin, reach, pair, progress);
  for (int a = 0; a < firsts; ++a) {
    if (barred[a] || fixed(a)) conflicts[a].clear();
    std::erase_if(conflicts[a], [&](int b) { return barred[firsts + b]; });
  }
  const SeamChoice stays = most_compatible(conflicts, seconds);
  for (int a = 0; a < firsts; ++a) before.stays[s.before[a]] = stays.first[a] && !barred[a];
  for (int b = 0; b < seconds; ++b) after.stays[s.after[b]] = stays.second[b] && !barred[firsts + b];
}

}  // namespace

Bin bin_of(const DemOptions& o) { return {o.length, o.width, o.periodic_x, o.periodic_y()}; }

Tiling tiling_of(const DemOptions& o) {
  Tiling tiling{1, 1, o.length, o.width};
  if (!(o.tile > 0.0) || !o.bed.empty()) return tiling;
  const auto pieces = [&](double side) { return std::max(1, static_cast<int>(std::lround(side / o.tile))); };
  tiling.along = pieces(o.length);
  tiling.across = pieces(o.width);
  tiling.length = o.length / tiling.along;
  tiling.width = o.width / tiling.across;
  return tiling;
}

bool is_tiled(const DemOptions& options) {
  const Tiling tiling = tiling_of(options);
  return tiling.along > 1 || tiling.across > 1;
}

DemOptions piece_of(const DemOptions& options) {
  const Tiling tiling = tiling_of(options);
  DemOptions piece = options;
  piece.tile = 0.0;
  piece.length = tiling.length;
  piece.width = tiling.width;
  piece.periodic_x = piece.piece = true;
  if (tiling.across > 1) piece.sides = "periodic";
  return piece;
}

std::vector<Quad> tiled_positions(const std::vector<Quad>& piece, const DemOptions& options,
                                  const ProgressCall& progress) {
  FURROW_ASSERT(is_tiled(options), options.tile);
  const Tiling tiling = tiling_of(options);
  const double overlap = largest_overlap(piece, piece_of(options), progress);
  std::vector<Quad> bed;
  const auto take = [&](const Column& column) {
    for (std::size_t g = 0; g < column.grains.size(); ++g)
      if (column.stays[g]) bed.push_back(column.grains[g]);
  };
  Column last = column_of(piece, options, tiling, 0);
  for (int number = 1; number < tiling.along; ++number) {
    if (progress) progress(kJoining, static_cast<double>(number) / tiling.along);
    Column column = column_of(piece, options, tiling, number);
    join(last, column, overlap, options, progress);
    take(last);
    last = std::move(column);
  }
  take(last);
  return bed;
}

double expected_tiled_grains(const DemOptions& o, double piece) {
  const Tiling tiling = tiling_of(o);
  const bool cut = tiling.across > 1 && !o.periodic_y();
  const double wall = 2.0 * o.radius;  // no centre is nearer to a wall than a radius
  return piece * (o.length - wall) * (o.width - (cut ? wall : 0.0)) / (tiling.length * tiling.width);
}

void check_tiling(const DemOptions& o) {
  if (!is_tiled(o)) return;
  const Tiling tiling = tiling_of(o);
  const double least = kLeastPiece * largest_radius(o);
  if (tiling.length < least || tiling.width < least)
    throw input_error(
        o.scenario, "terrain.tile",
        fmt::format("is {:g} m and gives {} × {} pieces of {:.3g} × {:.3g} m, expected pieces of at least "
                    "{:g} × {:g} m for these grains",
                    o.tile, tiling.along, tiling.across, tiling.length, tiling.width, least, least));
}

}  // namespace furrow::terrain::dem
