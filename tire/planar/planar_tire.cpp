#include "tire/planar/planar_tire.hpp"

#include <utility>

#include "protocol/core/assert.hpp"
#include "tire/extruded/extruded_tire.hpp"
#include "tire/planar/planar_carcass.hpp"

namespace furrow::tire {

MassProperties planar_mass(const PlanarParams& params) {
  const PlanarCarcass carcass(params);
  const double mass = carcass.total_mass(), spin = carcass.spin_inertia();
  const double diametral = 0.5 * spin + mass * params.options.width * params.options.width / 12.0;
  return {mass, Vec3(diametral, spin, diametral).asDiagonal()};
}

std::unique_ptr<Tire> make_planar_tire(const PlanarFile& file, TireShape shape, const Vec3& gravity) {
  FURROW_ASSERT(file.params.integrator == PlanarIntegrator::semi_implicit_euler);
  return make_extruded_tire(std::make_unique<PlanarCarcass>(file.params), std::move(shape), gravity);
}

}  // namespace furrow::tire
