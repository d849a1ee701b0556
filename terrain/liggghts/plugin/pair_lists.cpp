#include "terrain/liggghts/plugin/pair_lists.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/dem/near_four.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr int kLanes = 4;            // of near_four
constexpr double kMostCells = 512;   // along z: higher grains share the top cell
constexpr double kMostAcross = 1e5;  // along x and y

/// Rounded down into [0, count). A position that is not a number gets the first cell.
int cell_at(double place, int count) { return place > 0.0 ? static_cast<int>(std::min(place, count - 1.0)) : 0; }

int count_of(double length, double per_cell, double most) {
  const double cells = std::floor(length * per_cell) + 1.0;
  return cells > 1.0 ? static_cast<int>(std::min(cells, most)) : 1;
}

}  // namespace

void PairLists::make(const Grains& grains) {
  ++builds_;
  std::swap(now_, before_);
  lay_cells(grains);
  sort(grains, 0, grains.own, own_);
  sort(grains, grains.own, grains.all, ghosts_);
  row_of_.resize(grains.own);
  for (int row = 0; row < grains.own; ++row) row_of_[own_.grain[row]] = row;
  list_rows(grains);
  const std::size_t entries = now_.partner.size();
  now_.touching.assign(entries, 0);
  now_.tangential.assign(entries, {});
  now_.rolling.assign(setup_.rolling ? entries : 0, {});
  if (valid_) carry(grains.own);
  valid_ = true;
}

/// Cells are as wide as the reach of a pair. Grains outside of the grid belong to its outer cells.
void PairLists::lay_cells(const Grains& grains) {
  const double reach = 2.0 * setup_.largest + setup_.skin;
  double top = 0.0;
  for (int i = 0; i < grains.all; ++i) top = grains.position[i][2] > top ? grains.position[i][2] : top;
  per_cell_ = 1.0 / reach;
  x_begin_ = grains.x_min - 2.0 * reach;
  nx_ = count_of(grains.x_max - grains.x_min + 4.0 * reach, per_cell_, kMostAcross);
  ny_ = count_of(setup_.width, per_cell_, kMostAcross);
  nz_ = count_of(top, per_cell_, kMostCells);
}

void PairLists::sort(const Grains& grains, int from, int to, Grid& grid) {
  grid.start.assign(static_cast<std::size_t>(nx_) * ny_ * nz_ + 1, 0);
  const int count = to - from;
  grid.grain.resize(count);
  grid.at.resize(count + kLanes);
  cell_.resize(count);
  for (int k = 0; k < count; ++k) {
    const double* const x = grains.position[from + k];
    const int at_x = cell_at((x[0] - x_begin_) * per_cell_, nx_);
    const int at_y = cell_at((x[1] + 0.5 * setup_.width) * per_cell_, ny_);
    cell_[k] = (at_x * ny_ + at_y) * nz_ + cell_at(x[2] * per_cell_, nz_);
    ++grid.start[cell_[k] + 1];
  }
  for (std::size_t c = 1; c < grid.start.size(); ++c) grid.start[c] += grid.start[c - 1];
  // While a cell is filled, its start moves to its end, which is the start of the next cell.
  for (int k = 0; k < count; ++k) {
    const int to_place = grid.start[cell_[k]]++;
    const double* const x = grains.position[from + k];
    grid.grain[to_place] = from + k;
    grid.at[to_place] = {x[0], x[1], x[2], grains.radius[from + k]};
  }
  for (std::size_t c = grid.start.size() - 1; c > 0; --c) grid.start[c] = grid.start[c - 1];
  grid.start[0] = 0;
}

void PairLists::list_rows(const Grains& grains) {
  now_.grain = own_.grain;
  now_.first.resize(grains.own + 1);
  std::vector<std::int32_t>& partner = now_.partner;
  partner.resize(std::max<std::size_t>(before_.partner.size(), kLanes));
  std::size_t found = 0;
  const auto scan = [&](const dem::Double4& at, const Grid& grid, int from, int to) {
    if (from >= to) return;
    if (found + static_cast<std::size_t>(to - from + kLanes) > partner.size())
      partner.resize(2 * (found + static_cast<std::size_t>(to - from + kLanes)));
    const std::int32_t* const grain = grid.grain.data();
    for (int j = from; j < to; j += kLanes) {
      const unsigned hit = dem::near_four(grid.at.data() + j, to - j, at, setup_.skin, 0.0);
      for (int m = 0; m < kLanes; ++m) {  // without a branch, because the outcome cannot be predicted
        partner[found] = grain[std::min(j + m, to - 1)];
        found += hit >> m & 1;
      }
    }
  };
  const bool any_ghosts = grains.all > grains.own;
  for (int x = 0; x < nx_; ++x) {
    const int left = std::max(x - 1, 0), right = std::min(x + 1, nx_ - 1);
    const bool ghosts_near = any_ghosts && ghosts_.start[left * ny_ * nz_] < ghosts_.start[(right + 1) * ny_ * nz_];
    for (int y = 0; y < ny_; ++y) {
      const int before = std::max(y - 1, 0), after = std::min(y + 1, ny_ - 1);
      for (int z = 0; z < nz_; ++z) {
        const int cell = (x * ny_ + y) * nz_ + z;
        const int below = std::max(z - 1, 0), above = std::min(z + 1, nz_ - 1) + 1;
        const auto column = [&](const Grid& grid, int at_x, int at_y, const dem::Double4& at) {
          const int base = (at_x * ny_ + at_y) * nz_;
          scan(at, grid, grid.start[base + below], grid.start[base + above]);
        };
        for (int row = own_.start[cell]; row < own_.start[cell + 1]; ++row) {
          now_.first[row] = static_cast<std::int32_t>(found);
          const dem::Double4 at = dem::load(own_.at[row]);
          scan(at, own_, row + 1, own_.start[(x * ny_ + y) * nz_ + above]);
          if (y + 1 < ny_) column(own_, x, y + 1, at);
          if (x + 1 < nx_)
            for (int at_y = before; at_y <= after; ++at_y) column(own_, x + 1, at_y, at);
          if (!ghosts_near) continue;
          for (int at_x = left; at_x <= right; ++at_x)
            for (int at_y = before; at_y <= after; ++at_y) column(ghosts_, at_x, at_y, at);
        }
      }
    }
  }
  now_.first[grains.own] = static_cast<std::int32_t>(found);
  partner.resize(found);
}

int PairLists::entry_of(int i, int j) const {
  const int row = row_of_[i];
  for (int e = begin(row); e < end(row); ++e)
    if (now_.partner[e] == j) return e;
  return -1;
}

void PairLists::carry(int own) {
  for (std::size_t row = 0; row + 1 < before_.first.size(); ++row)
    for (int e = before_.first[row]; e < before_.first[row + 1]; ++e) {
      if (!before_.touching[e]) continue;
      const int i = before_.grain[row], j = before_.partner[e];
      PairHistory old{before_.tangential[e], {}};
      if (setup_.rolling) old.rolling = before_.rolling[e];
      if (const int entry = entry_of(i, j); entry >= 0) {
        remember(entry, old);
      } else if (j < own) {
        if (const int other = entry_of(j, i); other >= 0) remember(other, old.turned());
      }
    }
}

PairHistory PairLists::history(int entry) const {
  PairHistory h{now_.tangential[entry], {}};
  if (setup_.rolling) h.rolling = now_.rolling[entry];
  return h;
}

void PairLists::remember(int entry, const PairHistory& history) {
  now_.touching[entry] = 1;
  now_.tangential[entry] = history.tangential;
  if (setup_.rolling) now_.rolling[entry] = history.rolling;
}

}  // namespace furrow::terrain::liggghts
