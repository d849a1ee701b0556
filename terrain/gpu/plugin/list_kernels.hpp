// Sorts grains by cells and lists the neighbours of each, by their numbers.
//
// A list has all neighbours whose surfaces are closer than the skin; it stays complete until some grain has moved by
// half of the skin. Entries are in the order of the neighbours' numbers, and histories of touching pairs are found
// again by them. So neither forces nor histories depend on when lists are made.
#pragma once

#include "terrain/gpu/plugin/pair_kernel.hpp"
#include "terrain/gpu/plugin/wall_kernel.hpp"

namespace furrow::terrain::gpu {

struct Cells {
  i32 nx, ny, nz;
  double per_x, per_y, per_z;  // cells per metre
  double y0;                   // lowest y, m
  bool periodic_x, periodic_y;

  FURROW_HD static i32 at(double v, i32 n) {
    return v > 0.0 ? (v < static_cast<double>(n) ? static_cast<i32>(v) : n - 1) : 0;
  }
  FURROW_HD i32 x(double v) const { return at(v * per_x, nx); }
  FURROW_HD i32 y(double v) const { return at((v - y0) * per_y, ny); }
  FURROW_HD i32 z(double v) const { return at(v * per_z, nz); }
  FURROW_HD i32 index(i32 cx, i32 cy, i32 cz) const { return (cx * ny + cy) * nz + cz; }
};

/// Moves grains back between periodic sides and finds their cells; finds those outside the bin.
struct CellKernel {
  Pointers g;
  Cells cells;
  Images images;
  dem::Bin bin;
  u32 *key, *place;

  FURROW_HD static void wrap(u32& low, i32& high, i64 length, i64 from) {
    i64 p = Pointers::join(low, high);
    while (p < from) p += length;
    while (p >= from + length) p -= length;
    low = static_cast<u32>(p), high = static_cast<i32>(p >> 32);
  }
  FURROW_HD void operator()(int i) const {
    Low& l = g.low[i];
    High& h = g.high[i];
    if (bin.periodic_x) wrap(l.x, h.x, images.length, 0);
    if (bin.periodic_y) wrap(l.y, h.y, images.width, -images.width / 2);
    const Triple<double> p = g.position(i);
    const bool inside = (bin.periodic_x || (p.x >= 0.0 && p.x <= bin.length)) &&
                        (bin.periodic_y || (p.y >= -0.5 * bin.width && p.y <= 0.5 * bin.width)) && p.z >= 0.0;
    if (!inside) atomic_min(&g.control->lost, l.id);
    key[i] = static_cast<u32>(cells.index(cells.x(p.x), cells.y(p.y), cells.z(p.z)));
    place[i] = static_cast<u32>(i);
  }
};

struct TopKernel {
  Pointers g;
  u64* top;  // bits of the largest height, m
  FURROW_HD void operator()(int i) const {
    const double z = g.position(i).z;
    if (z > 0.0) atomic_max(top, bits_of(z));
  }
};

/// Copies the state to the order of cells. @param order  old place of each grain
struct PermuteKernel {
  Pointers from, to;
  const u32* order;
  FURROW_HD void operator()(int i) const {
    const u32 o = order[i];
    to.low[i] = to.built[i] = from.low[o];
    to.high[i] = from.high[o];
    to.motion[i] = from.motion[o];
    to.row[i] = from.row[o];
    to.load[i] = from.load[o];
  }
};

/// @param start  first grain of each cell, and the end of the last
struct CellStartKernel {
  const u32* key;
  i32 count, cells;
  u32* start;
  FURROW_HD void operator()(int i) const {  // threads 0 … count
    const i64 from = i == 0 ? i64{-1} : i64{key[i - 1]}, to = i == count ? i64{cells} : i64{key[i]};
    for (i64 c = from + 1; c <= to; ++c) start[c] = static_cast<u32>(i);
  }
};

struct ListKernel {
  Pointers g;
  Cells cells;
  Images images;
  const u32* start;
  u64 reach2;  // u²
  i32 slots;
  u32* most;  // largest number of neighbours

  FURROW_HD static u64 square(i64 v) { return static_cast<u64>(v * v); }

  FURROW_HD void operator()(int i) const {
    const Low own = g.low[i];
    const High high = g.high[i];
    const i64 ox = Pointers::join(own.x, high.x), oy = Pointers::join(own.y, high.y),
              oz = Pointers::join(own.z, high.z);
    const Triple<double> p = g.position(i);
    const i32 cx = cells.x(p.x), cy = cells.y(p.y), cz = cells.z(p.z);
    const i32 below = cz > 0 ? cz - 1 : 0, above = cz + 1 < cells.nz ? cz + 1 : cz;
    u32 ids[kMostSlots], entries[kMostSlots];
    u32 count = 0;
    for (i32 dx = -1; dx <= 1; ++dx)
      for (i32 dy = -1; dy <= 1; ++dy) {
        i32 x = cx + dx, y = cy + dy;
        u32 image_x = 0, image_y = 0;  // seen from below the first cell a neighbour appears one length before its place
        if (cells.periodic_x) {
          if (x < 0) x += cells.nx, image_x = 1;
          if (x >= cells.nx) x -= cells.nx, image_x = 2;
        }
        if (cells.periodic_y) {
          if (y < 0) y += cells.ny, image_y = 1;
          if (y >= cells.ny) y -= cells.ny, image_y = 2;
        }
        if (x < 0 || x >= cells.nx || y < 0 || y >= cells.ny) continue;
        const i64 shift_x = image_x == 1 ? images.length : image_x == 2 ? -images.length : 0;
        const i64 shift_y = image_y == 1 ? images.width : image_y == 2 ? -images.width : 0;
        const u32 from = start[cells.index(x, y, below)], to = start[cells.index(x, y, above) + 1];
        for (u32 j = from; j < to; ++j) {
          if (j == static_cast<u32>(i)) continue;
          const Low other = g.low[j];
          const High other_high = g.high[j];
          const i64 ex = ox - Pointers::join(other.x, other_high.x) + shift_x,
                    ey = oy - Pointers::join(other.y, other_high.y) + shift_y,
                    ez = oz - Pointers::join(other.z, other_high.z);
          constexpr i64 kFar = i64{1} << 31;
          if (ex >= kFar || ex <= -kFar || ey >= kFar || ey <= -kFar || ez >= kFar || ez <= -kFar) continue;
          if (square(ex) + square(ey) + square(ez) >= reach2) continue;
          if (count < kMostSlots) {
            u32 at = count;
            for (; at > 0 && ids[at - 1] > other.id; --at) ids[at] = ids[at - 1], entries[at] = entries[at - 1];
            ids[at] = other.id;
            entries[at] = j | (image_x + 3 * image_y) << kSlotBits;
          }
          ++count;
        }
      }
    atomic_max(most, count);
    const u32 room = static_cast<u32>(slots);
    g.listed[i] = count < room ? count : room;
    for (u32 k = 0; k < count && k < room; ++k) g.list[k * g.stride + i] = entries[k];
  }
};

/// Finds the histories of touching pairs in the old lists.
struct CarryKernel {
  Pointers from, to;
  const u32* order;
  bool history, rolling;

  FURROW_HD void operator()(int i) const {
    const u32 o = order[i], touched = from.touching[o], old_count = from.listed[o];
    u32 now = 0, k = 0;
    for (u32 n = 0; n < old_count; ++n) {  // both lists rise
      if (!(touched >> n & 1U)) continue;
      const i64 old_place = n * from.stride + o;
      const u32 id = from.low[from.list[old_place] & kPlaceMask].id;
      while (k < to.listed[i] && to.low[to.list[k * to.stride + i] & kPlaceMask].id < id) ++k;
      if (k == to.listed[i]) break;
      const i64 place = k * to.stride + i;
      if (to.low[to.list[place] & kPlaceMask].id != id) continue;
      now |= 1U << k;
      if (history) to.spring[place] = from.spring[old_place];
      if (rolling) to.roll[place] = from.roll[old_place];
    }
    to.touching[i] = now;
  }
};

/// Marks grains near a wall.
struct NearWallKernel {
  Pointers g;
  dem::Bin bin;
  double reach;
  u32* flag;
  FURROW_HD void operator()(int i) const {
    const Triple<double> x = g.position(i);
    u32 near = 0;
    for (int wall = 0; wall < dem::kWalls; ++wall)
      if (has_wall(bin, wall) && distance_from(bin, wall, x) < reach) near = 1;
    flag[i] = near;
  }
};

/// Lists marked grains. @param sums  of the flags before each  @param entry_of  entry of each grain, or all bits set
struct EntriesKernel {
  const u32 *flag, *sums;
  u32 *grain, *entry_of;
  FURROW_HD void operator()(int i) const {
    entry_of[i] = flag[i] ? sums[i] : ~0U;
    if (flag[i]) grain[sums[i]] = static_cast<u32>(i);
  }
};

struct CarryWallsKernel {
  WallPointers from, to;
  const u32 *order, *old_entry_of;
  FURROW_HD void operator()(int e) const {
    const u32 old = old_entry_of[order[to.grain[e]]];
    for (int wall = 0; wall < dem::kWalls; ++wall)
      to.spring[e * dem::kWalls + wall] = old == ~0U ? WallSpring{} : from.spring[old * dem::kWalls + wall];
    to.floor[e] = old == ~0U ? 0.0 : from.floor[old];
    for (int k = 0; k < 3; ++k) to.impulse[3 * e + k] = 0;
  }
};

}  // namespace furrow::terrain::gpu
