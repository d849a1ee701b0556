#include "terrain/dem/pair_list.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::dem {
namespace {

constexpr int kMaxCellsZ = 512;  // higher grains share the top cell
constexpr int padded(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

void permute(std::vector<Quad>& values, const std::vector<std::int32_t>& order, int threads) {
  std::vector<Quad> out(values.size());
  const int n = static_cast<int>(order.size());
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int k = 0; k < n; ++k) out[k] = values[order[k]];
  out[n] = values[n];
  values.swap(out);
}

Quad negated(const Quad& q) { return {-q.x, -q.y, -q.z, q.w}; }

/// Where each old grain's touching pairs with history stand.
struct OldRows {
  struct Entry {
    std::int32_t partner;  // old index
    std::int32_t block, pair;
    bool reversed;  // this grain was the pair's j
  };
  std::vector<std::int32_t> start;
  std::vector<Entry> entries;

  OldRows(const std::vector<PairBlock>& blocks, int grains) : start(grains + 1, 0) {
    each(blocks, [&](int, int, int i, int j) { ++start[i + 1], ++start[j + 1]; });
    for (int g = 0; g < grains; ++g) start[g + 1] += start[g];
    entries.resize(start[grains]);
    std::vector<std::int32_t> next(start.begin(), start.end() - 1);
    each(blocks, [&](int b, int p, int i, int j) {
      entries[next[i]++] = {j, b, p, false};
      entries[next[j]++] = {i, b, p, true};
    });
  }

  const Entry* find(int grain, int partner) const {
    for (int e = start[grain]; e < start[grain + 1]; ++e)
      if (entries[e].partner == partner) return &entries[e];
    return nullptr;
  }

 private:
  template <class F>
  static void each(const std::vector<PairBlock>& blocks, F&& f) {
    for (int b = 0; b < static_cast<int>(blocks.size()); ++b)
      for (int group = 0; group < blocks[b].pairs / kLanes; ++group)
        for (int k = 0, mask = blocks[b].touching[group]; mask != 0; ++k, mask >>= 1)
          if (mask & 1)
            f(b, group * kLanes + k, blocks[b].i[group * kLanes + k], blocks[b].j[group * kLanes + k]);
  }
};

}  // namespace

void PairList::sort_by_cell(Grains& grains, int threads, std::vector<std::int32_t>& order) {
  const double size = 2.0 * options_.radius + options_.skin;
  const int n = grains.count;
  double top = 0.0;
  for (int g = 0; g < n; ++g) top = std::max(top, grains.position[g].z);
  cells_.inverse = 1.0 / size;
  cells_.x0 = 0.0;
  cells_.y0 = -0.5 * options_.bin.width;
  cells_.nx = std::max(1, static_cast<int>(std::ceil(options_.bin.length / size)));
  cells_.ny = std::max(1, static_cast<int>(std::ceil(options_.bin.width / size)));
  cells_.nz = std::clamp(static_cast<int>(top / size) + 1, 1, kMaxCellsZ);

  const auto index = [&](double x, int count) {
    return std::clamp(static_cast<int>(x * cells_.inverse), 0, count - 1);
  };
  std::vector<std::int32_t> cell(n);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int g = 0; g < n; ++g) {
    const Quad& p = grains.position[g];
    cell[g] =
        (index(p.x - cells_.x0, cells_.nx) * cells_.ny + index(p.y - cells_.y0, cells_.ny)) * cells_.nz +
        index(p.z, cells_.nz);
  }
  cells_.start.assign(static_cast<std::size_t>(cells_.nx) * cells_.ny * cells_.nz + 1, 0);
  for (int g = 0; g < n; ++g) ++cells_.start[cell[g] + 1];
  for (std::size_t c = 1; c < cells_.start.size(); ++c) cells_.start[c] += cells_.start[c - 1];
  order.resize(n);
  std::vector<std::int32_t> next(cells_.start.begin(), cells_.start.end() - 1);
  for (int g = 0; g < n; ++g) order[next[cell[g]]++] = g;

  cells_.cell.resize(n);
  std::vector<std::int32_t> id(n);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int g = 0; g < n; ++g) {
    cells_.cell[g] = cell[order[g]];
    id[g] = grains.id[order[g]];
  }
  grains.id.swap(id);
  for (auto* array : {&grains.position, &grains.velocity, &grains.spin, &grains.force, &grains.torque})
    permute(*array, order, threads);
  grains.listed_at = grains.position;
}

void PairList::size_block(PairBlock& block) const {
  block.i.resize(block.pairs);
  block.j.resize(block.pairs);
  block.touching.assign(block.pairs / kLanes, 0);
  block.tangential.assign(options_.history ? block.pairs : 0, Quad{});
  block.rolling.assign(options_.rolling ? block.pairs : 0, Quad{});
  const int slots = block.pairs - block.inner;
  block.slot_force.assign(slots, Quad{});
  block.slot_torque.assign(slots, Quad{});
}

void PairList::list_block(const Grains& grains, PairBlock& block) const {
  const double reach = 2.0 * options_.radius + options_.skin, reach2 = reach * reach;
  thread_local std::vector<std::int32_t> inner_i, inner_j, outer_i, outer_j;
  inner_i.clear(), inner_j.clear(), outer_i.clear(), outer_j.clear();
  const int ny = cells_.ny, nz = cells_.nz;

  for (int i = block.first; i < block.last; ++i) {
    const Lane at = load(grains.position[i]);
    const auto scan = [&](int from, int to) {
      for (int j = from; j < to; ++j) {
        const Lane d = load(grains.position[j]) - at;
        const Lane d2 = d * d;
        if (d2[0] + d2[1] + d2[2] >= reach2) continue;
        if (j < block.last) {
          inner_i.push_back(i), inner_j.push_back(j);
        } else {
          outer_i.push_back(i), outer_j.push_back(j);
        }
      }
    };
    const int c = cells_.cell[i], iz = c % nz, iy = c / nz % ny, ix = c / nz / ny;
    const int below = iz > 0 ? -1 : 0, above = iz < nz - 1 ? 1 : 0;
    scan(i + 1, cells_.start[c + above + 1]);
    if (iy < ny - 1) scan(cells_.start[c + nz + below], cells_.start[c + nz + above + 1]);
    if (ix < cells_.nx - 1)
      for (int y = std::max(iy - 1, 0); y <= std::min(iy + 1, ny - 1); ++y) {
        const int other = ((ix + 1) * ny + y) * nz + iz;
        scan(cells_.start[other + below], cells_.start[other + above + 1]);
      }
  }
  block.inner = padded(static_cast<int>(inner_i.size()));
  block.pairs = block.inner + padded(static_cast<int>(outer_i.size()));
  size_block(block);
  std::fill(block.i.begin(), block.i.end(), block.first);
  std::fill(block.j.begin(), block.j.end(), grains.count);
  std::copy(inner_i.begin(), inner_i.end(), block.i.begin());
  std::copy(inner_j.begin(), inner_j.end(), block.j.begin());
  std::copy(outer_i.begin(), outer_i.end(), block.i.begin() + block.inner);
  std::copy(outer_j.begin(), outer_j.end(), block.j.begin() + block.inner);
}

void PairList::list_walls(const Grains& grains, PairBlock& block) const {
  const double reach = options_.radius + options_.skin;
  block.walls.clear();
  for (int g = block.first; g < block.last; ++g)
    for (int wall = 0; wall < kWalls; ++wall)
      if (options_.bin.distance(wall, grains.position[g]) < reach) block.walls.push_back({g, wall, {}, {}});
}

void PairList::carry_history(const Grains& grains, const std::vector<PairBlock>& old,
                             const std::vector<std::int32_t>& order, int threads) {
  const OldRows rows(old, grains.count);
  struct WallKey {
    std::int32_t grain, block, entry;
  };
  std::vector<std::int32_t> new_of(grains.count);
  for (int g = 0; g < grains.count; ++g) new_of[order[g]] = g;
  std::vector<std::int32_t> wall_start(grains.count + 1, 0);
  std::vector<WallKey> wall_keys;
  for (int b = 0; b < static_cast<int>(old.size()); ++b)
    for (int e = 0; e < static_cast<int>(old[b].walls.size()); ++e)
      if (old[b].walls[e].tangential.w > 0.0) wall_keys.push_back({new_of[old[b].walls[e].grain], b, e});
  std::stable_sort(wall_keys.begin(), wall_keys.end(), [](auto& a, auto& b) { return a.grain < b.grain; });

  const int count = static_cast<int>(blocks_.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (int b = 0; b < count; ++b) {
    PairBlock& block = blocks_[b];
    for (int p = 0; p < block.pairs; ++p) {
      if (block.j[p] == grains.count) continue;
      const auto* found = rows.find(order[block.i[p]], order[block.j[p]]);
      if (!found) continue;
      block.touching[p / kLanes] |= static_cast<std::uint8_t>(1 << p % kLanes);
      const PairBlock& from = old[found->block];
      if (options_.history)
        block.tangential[p] =
            found->reversed ? negated(from.tangential[found->pair]) : from.tangential[found->pair];
      if (options_.rolling)
        block.rolling[p] = found->reversed ? negated(from.rolling[found->pair]) : from.rolling[found->pair];
    }
    for (WallContact& contact : block.walls) {
      auto key = std::lower_bound(wall_keys.begin(), wall_keys.end(), contact.grain,
                                  [](const WallKey& k, int grain) { return k.grain < grain; });
      for (; key != wall_keys.end() && key->grain == contact.grain; ++key) {
        const WallContact& from = old[key->block].walls[key->entry];
        if (from.wall != contact.wall) continue;
        contact.tangential = from.tangential;
        contact.rolling = from.rolling;
      }
    }
  }
}

void PairList::link_slots() {
  for (PairBlock& block : blocks_) block.incoming.clear();
  for (int b = 0; b < static_cast<int>(blocks_.size()); ++b)
    for (int p = blocks_[b].inner; p < blocks_[b].pairs; ++p) {
      const int target = blocks_[b].j[p] / kBlockGrains;
      if (target < static_cast<int>(blocks_.size()) && blocks_[b].j[p] < blocks_[target].last)
        blocks_[target].incoming.push_back({b, p - blocks_[b].inner, blocks_[b].j[p]});
    }
}

void PairList::rebuild(Grains& grains, int threads, std::vector<std::int32_t>& order) {
  sort_by_cell(grains, threads, order);
  const std::vector<PairBlock> old = std::move(blocks_);
  const int count = (grains.count + kBlockGrains - 1) / kBlockGrains;
  blocks_.assign(count, {});
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (int b = 0; b < count; ++b) {
    PairBlock& block = blocks_[b];
    block.first = b * kBlockGrains;
    block.last = std::min(block.first + kBlockGrains, grains.count);
    if (!old.empty()) block.sums = old[b].sums;
    list_block(grains, block);
    list_walls(grains, block);
  }
  carry_history(grains, old, order, threads);
  finish(grains);
  ++rebuilds_;
}

void PairList::finish(const Grains& grains) {
  for (PairBlock& block : blocks_) {
    block.x_min = 1e300, block.x_max = -1e300;
    for (int g = block.first; g < block.last; ++g) {
      block.x_min = std::min(block.x_min, grains.listed_at[g].x);
      block.x_max = std::max(block.x_max, grains.listed_at[g].x);
    }
  }
  link_slots();
}

}  // namespace furrow::dem
