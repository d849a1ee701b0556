#include "terrain/dem/tires/surface_start.hpp"

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"
#include "terrain/dem/tires/bin_sides.hpp"

namespace furrow::terrain::dem {

void check_surface_start(const DemOptions& options, const Bin& bin, const ContactMaterial& material,
                         const SurfaceState& start, int index) {
  check_material(material, law_from(options.law), index);
  for (const Vec3& x : start.position)
    if (const char* wall = side_crossed(bin, {x, x}))
      throw input_error(options.scenario, "terrain",
                        fmt::format("the tire starts beyond {}: it has a point at ({:.4g}, {:.4g}, {:.4g}) "
                                    "m; expected a larger bin or another start",
                                    wall, x.x(), x.y(), x.z()));
}

}  // namespace furrow::terrain::dem
