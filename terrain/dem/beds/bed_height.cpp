#include "terrain/dem/beds/bed_height.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::dem {

HeightField bed_height_field(const Grains& grains, const Bin& bin, double cell) {
  FURROW_ASSERT(cell > 0.0 && bin.length > 0.0 && bin.width > 0.0, cell, bin.length, bin.width);
  FURROW_ASSERT(grains.position.size() >= static_cast<std::size_t>(grains.count), grains.position.size(), grains.count);
  HeightField field;
  field.cell = cell;
  field.nx = std::max(1, static_cast<int>(bin.length / field.cell));
  field.ny = std::max(1, static_cast<int>(bin.width / field.cell));
  field.x0 = 0.5 * field.cell;
  field.y0 = 0.5 * field.cell - 0.5 * bin.width;
  field.height.assign(static_cast<std::size_t>(field.nx) * field.ny, std::numeric_limits<double>::quiet_NaN());
  for (int g = 0; g < grains.count; ++g) {
    const Quad& p = grains.position[g];
    const int ix = std::clamp(static_cast<int>(p.x / field.cell), 0, field.nx - 1);
    const int iy = std::clamp(static_cast<int>((p.y + 0.5 * bin.width) / field.cell), 0, field.ny - 1);
    double& height = field.height[static_cast<std::size_t>(ix) * field.ny + iy];
    if (!(height >= p.z + p.w)) height = p.z + p.w;
  }
  return field;
}

double mean_height(const HeightField& field, double x_min, double x_max, double y_min, double y_max) {
  FURROW_ASSERT(field.height.size() == static_cast<std::size_t>(field.nx) * field.ny, field.height.size(), field.nx,
                field.ny);
  FURROW_ASSERT(x_min <= x_max && y_min <= y_max, x_min, x_max, y_min, y_max);
  double sum = 0.0;
  int cells = 0;
  for (int ix = 0; ix < field.nx; ++ix)
    for (int iy = 0; iy < field.ny; ++iy) {
      const double x = field.x0 + ix * field.cell, y = field.y0 + iy * field.cell;
      const double height = field.height[static_cast<std::size_t>(ix) * field.ny + iy];
      if (x < x_min || x > x_max || y < y_min || y > y_max || std::isnan(height)) continue;
      sum += height;
      ++cells;
    }
  return cells > 0 ? sum / cells : 0.0;
}

double top_height(const Grains& grains, double x_min, double x_max, double y_min, double y_max) {
  FURROW_ASSERT(x_min <= x_max && y_min <= y_max, x_min, x_max, y_min, y_max);
  double top = 0.0;
  for (int g = 0; g < grains.count; ++g) {
    const Quad& p = grains.position[g];
    if (p.x > x_min - p.w && p.x < x_max + p.w && p.y > y_min - p.w && p.y < y_max + p.w)
      top = std::max(top, p.z + p.w);
  }
  return top;
}

}  // namespace furrow::terrain::dem
