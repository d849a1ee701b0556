// Tests which of four grains are near another one: the most frequent operation of the neighbour search.
#pragma once

#include <algorithm>
#include <cmath>

#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Bits of the four grains at x, x + 1, … (the first `valid` of them) whose surface is closer than `skin` to that of
/// the grain at `at`. @param width  of a bin that is periodic in y, m; 0 if it is not
inline unsigned near_four(const Quad* x, int valid, Double4 at, double skin, double width) {
  const auto d = [&](int k) { return load(x[k]) - at; };
  Double4 r[4] = {d(0), d(1), d(2), d(3)};
  transpose(r);
  if (width > 0.0)
    for (int k = 0; k < 4; ++k) r[1][k] -= width * std::round(r[1][k] / width);
  const Double4 reach = r[3] + (2.0 * at[3] + skin);
  const Double4 room = reach * reach - (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  return positive(room) & ((1u << std::min(valid, 4)) - 1u);
}

}  // namespace furrow::terrain::dem
