#include "tire/tire.hpp"

#include <fmt/format.h>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

void Tire::place(const RimState& rim) {
  do_place(rim);
  placed_ = true;
}

Outcome Tire::advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) {
  const std::size_t count = forces.vertex.size();
  FURROW_ASSERT(placed_, substeps);
  FURROW_ASSERT(substeps > 0 && rim.duration() > 0.0, substeps, rim.duration());
  FURROW_ASSERT(forces.force.size() == count, forces.force.size(), count);
  FURROW_ASSERT(forces.tangent.empty() || forces.tangent.size() == count, forces.tangent.size(), count);
  const RimState& end = rim.end();
  if (!end.position.allFinite() || !end.orientation.coeffs().allFinite() || !end.velocity.allFinite() ||
      !end.angular_velocity.allFinite())
    return Outcome::failure("has a rim whose motion is not finite", "try a smaller run.step");
  for (std::size_t k = 0; k < count; ++k) {
    FURROW_ASSERT(in_range(forces.vertex[k], mesh().vertex_count), forces.vertex[k], mesh().vertex_count);
    if (!forces.force[k].allFinite())
      return Outcome::failure("was given a force that is not finite",
                              fmt::format("on vertex {} of its surface; try a smaller run.step", forces.vertex[k]));
  }
  return do_advance(rim, forces, substeps);
}

void Tire::surface_on(const RimState&, SurfaceState&) const { FURROW_ASSERT(false, mesh().vertex_count); }

void Tire::restore(const Archive& archive) {
  do_restore(archive);
  placed_ = true;
}

}  // namespace furrow::tire
