#include "terrain/dem/bed_height.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::dem {

HeightField bed_height_field(const Grains& grains, const Bin& bin, double radius) {
  HeightField field;
  field.cell = 2.0 * radius;
  field.nx = std::max(1, static_cast<int>(bin.length / field.cell));
  field.ny = std::max(1, static_cast<int>(bin.width / field.cell));
  field.x0 = 0.5 * field.cell;
  field.y0 = 0.5 * field.cell - 0.5 * bin.width;
  field.height.assign(static_cast<std::size_t>(field.nx) * field.ny,
                      std::numeric_limits<double>::quiet_NaN());
  for (int g = 0; g < grains.count; ++g) {
    const Quad& p = grains.position[g];
    const int ix = std::clamp(static_cast<int>(p.x / field.cell), 0, field.nx - 1);
    const int iy = std::clamp(static_cast<int>((p.y + 0.5 * bin.width) / field.cell), 0, field.ny - 1);
    double& cell = field.height[static_cast<std::size_t>(ix) * field.ny + iy];
    if (!(cell >= p.z + radius)) cell = p.z + radius;
  }
  return field;
}

double mean_height(const HeightField& field, double x_min, double x_max, double y_min, double y_max) {
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

double top_height(const Grains& grains, double radius, double x_min, double x_max, double y_min,
                  double y_max) {
  double top = 0.0;
  for (int g = 0; g < grains.count; ++g) {
    const Quad& p = grains.position[g];
    if (p.x > x_min - radius && p.x < x_max + radius && p.y > y_min - radius && p.y < y_max + radius)
      top = std::max(top, p.z + radius);
  }
  return top;
}

}  // namespace furrow::dem
