#include "tire/planar/planar_tire.hpp"

#include <utility>

#include "tire/extruded/extruded_tire.hpp"
#include "tire/planar/planar_carcass.hpp"
#include "tire/planar/tread_contact.hpp"

namespace furrow::tire {

MassProperties planar_mass(const PlanarParams& params) {
  const PlanarCarcass carcass(params);
  const double mass = carcass.total_mass(), spin = carcass.spin_inertia();
  const double diametral = 0.5 * spin + mass * params.options.width * params.options.width / 12.0;
  return {mass, Vec3(diametral, spin, diametral).asDiagonal()};
}

std::unique_ptr<Tire> make_planar_tire(const PlanarFile& file, TireShape shape, const Vec3& gravity,
                                       const GroundProfilePoints& ground) {
  const PlanarParams& p = file.params;
  auto carcass = std::make_unique<PlanarCarcass>(p);
  if (p.contact == PlanarContactOf::penalty)
    carcass->set_contact(make_tread_contact(carcass->mesh(), carcass->tread(), carcass->mass(),
                                            {p.contact_stiffness * p.options.width, p.friction}, ground));
  return make_extruded_tire(std::move(carcass), std::move(shape), gravity);
}

}  // namespace furrow::tire
