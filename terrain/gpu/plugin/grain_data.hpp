// The state of grains on a device, one array per quantity, in the order of their cells.
//
// Positions are whole numbers of a unit u, a power of two of a metre: 64 bits, whose low and high halves are kept
// apart. Grains near each other differ by less than 2^31 u, so the difference of the low halves is their exact
// distance, whatever the carry. Nothing is lost far from the origin, and a grain moves as soon as dt v > u/2.
// D² − d² is exact in 64 bits, and is rounded once, for the contact law in single precision.
#pragma once

#include "protocol/core/triple.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/gpu/plugin/device.hpp"

namespace furrow::terrain::gpu {

using simd::Triple;

struct alignas(16) Low {
  u32 x, y, z;
  u32 id;
};
struct alignas(16) High {
  i32 x, y, z, unused;
};
struct alignas(16) Motion {
  double v[3], w[3];  // m/s, rad/s
};
/// The motion as neighbours read it.
struct alignas(16) MotionRow {
  float v[3], w[3];
  float unused[2];
};
struct alignas(16) Load {
  double f[3], t[3];  // N, N m
};
/// Spring of one pair; w = √δ of the previous step (tangential only).
struct alignas(16) SpringRow {
  float x, y, z, w;
};

inline constexpr int kMostSlots = 32;  // of a list: bits of `touching`
inline constexpr u32 kSlotBits = 28;   // of an entry: the neighbour's place; above: the image of it
inline constexpr u32 kPlaceMask = (1U << kSlotBits) - 1;

/// What a step decides on the device.
struct Control {
  u32 stop;                       // 1: lists must be made anew, 2: contacts may be too deep, 4: a grain was lost
  u32 lost;                       // smallest number of a lost grain; all bits set: none
  u32 overlap;                    // bits of the largest overlap in the present step, m
  u32 deepest;                    // the same since the last readback
  u32 speed2;                     // bits of the largest v² after the present step, m²/s²
  u32 done;                       // steps
  u32 last_overlap, last_speed2;  // of the last step
  u64 travel2;                    // largest squared distance from where lists were made, u²
};
inline constexpr u32 kStopLists = 1, kStopOverlap = 2, kStopLost = 4;

struct Pointers {
  i32 count;
  i64 stride;   // grains that the columns of lists have room for
  double unit;  // u, m
  double per_unit;
  Low* low;
  High* high;
  Motion* motion;
  MotionRow* row;
  Load* load;
  Low* built;  // positions when lists were made; `id` is not used
  u32* list;   // [slot * stride + grain], by rising number of the neighbour
  u32* listed;
  u32* touching;             // bit per slot: touched in the last step
  SpringRow *spring, *roll;  // [slot * stride + grain]
  Control* control;

  FURROW_HD static i64 join(u32 low, i32 high) {
    return static_cast<i64>(static_cast<u64>(static_cast<u32>(high)) << 32 | low);
  }
  FURROW_HD Triple<double> position(int g) const {
    const Low& l = low[g];
    const High& h = high[g];
    return {unit * static_cast<double>(join(l.x, h.x)), unit * static_cast<double>(join(l.y, h.y)),
            unit * static_cast<double>(join(l.z, h.z))};
  }
};

/// Differences of the low halves over the images of a periodic bin: + 0, + its length, − its length.
struct Images {
  u32 x[3], y[3];
  i64 length, width;  // u
};

FURROW_HD inline Triple<double> triple(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
FURROW_HD inline Triple<float> triple(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
FURROW_HD inline void add(double (&to)[3], const Triple<double>& v) { to[0] += v.x, to[1] += v.y, to[2] += v.z; }
FURROW_HD inline void set(double (&to)[3], const Triple<double>& v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

}  // namespace furrow::terrain::gpu
