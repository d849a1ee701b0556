#include "terrain/terrain.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "terrain/surface/surface_check.hpp"

namespace furrow::terrain {

double Terrain::prepare(const ProgressCall& progress) {
  const double wall_s = do_prepare(progress);
  prepared_ = true;
  return wall_s;
}

void Terrain::attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) {
  check_surface(mesh, start, static_cast<int>(attached()));
  do_attach(mesh, material, start);
}

void Terrain::state_contacts(std::span<const StatedContact> contacts) {
  FURROW_ASSERT(std::ranges::none_of(contacts, &StatedContact::given), contacts.size());
}

Outcome Terrain::advance(std::span<const SurfaceState> targets, double duration, int substeps,
                         std::span<NodalForces> forces, std::span<ContactSums> contact) {
  FURROW_ASSERT(prepared_, substeps);
  FURROW_ASSERT(duration > 0.0 && substeps > 0, duration, substeps);
  FURROW_ASSERT(targets.size() == attached(), targets.size(), attached());
  FURROW_ASSERT(forces.size() == attached(), forces.size(), attached());
  FURROW_ASSERT(contact.size() == attached(), contact.size(), attached());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto& [position, velocity] = targets[k];
    FURROW_ASSERT(position.size() == vertices(k), k, position.size(), vertices(k));
    FURROW_ASSERT(velocity.size() == vertices(k), k, velocity.size(), vertices(k));
    for (std::size_t v = 0; v < position.size(); ++v)
      if (const Vec3 end = position[v] + duration * velocity[v]; !end.allFinite())
        return Outcome::failure("was given a surface that is not finite",
                                fmt::format("vertex {} of surface {}; try a smaller run.step", v, k));
  }
  return do_advance(targets, duration, substeps, forces, contact);
}

void Terrain::set_threads(int threads) { FURROW_ASSERT(threads > 0, threads); }

void Terrain::restore(const Archive& archive) {
  do_restore(archive);
  prepared_ = true;
}

}  // namespace furrow::terrain
