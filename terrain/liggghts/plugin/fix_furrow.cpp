#include "terrain/liggghts/plugin/fix_furrow.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <atom.h>
#include <comm.h>
#include <error.h>

namespace furrow::terrain::liggghts {
namespace {

constexpr int kCarriedSize = sizeof(Carried) / sizeof(double);
static_assert(kCarriedSize * sizeof(double) == sizeof(Carried));

}  // namespace

FixFurrow::FixFurrow(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg) : Fix(lmp, narg, arg) {
  time_integrate = 1;
  create_attribute = 1;
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  comm->maxexchange_fix += 1 + kMostCarried * kCarriedSize;
}

FixFurrow::~FixFurrow() { atom->delete_callback(id, 0); }

int FixFurrow::setmask() {
  namespace when = LAMMPS_NS::FixConst;
  return when::PRE_NEIGHBOR | when::PRE_FORCE | when::POST_FORCE | when::FINAL_INTEGRATE;
}

OwnGrains FixFurrow::own() {
  OwnGrains g;
  g.count = atom->nlocal;
  if (g.count == 0) return g;
  g.position = reinterpret_cast<const double(*)[3]>(atom->x[0]);
  g.velocity = reinterpret_cast<const double(*)[3]>(atom->v[0]);
  g.spin = reinterpret_cast<const double(*)[3]>(atom->omega[0]);
  g.radius = atom->radius;
  g.id = atom->tag;
  g.force = reinterpret_cast<double(*)[3]>(atom->f[0]);
  g.torque = reinterpret_cast<double(*)[3]>(atom->torque[0]);
  g.carried = carried_.data();
  return g;
}

void FixFurrow::pre_neighbor() {
  for (int i = 0; i < atom->nlocal; ++i) listed_[i] = {atom->x[i][0], atom->x[i][1], atom->x[i][2]};
}

void FixFurrow::pre_force(int) {
  losses_ = work_->begin_step();
  pair_->want_losses(losses_);
}

void FixFurrow::post_force(int) { work_->add_forces(own(), losses_); }

void FixFurrow::final_integrate() {
  const double kick = times_.kick, dt = times_.dt;
  const double mass = setup_.grain.mass, inertia = setup_.grain.inertia, radius = setup_.grain.radius;
  double per_mass = 1.0 / mass, per_inertia = 1.0 / inertia;
  for (int g = 0; g < atom->nlocal; ++g) {
    double *const x = atom->x[g], *const v = atom->v[g], *const w = atom->omega[g];
    const double *const f = atom->f[g], *const t = atom->torque[g];
    if (setup_.sizes) {
      const double size = atom->radius[g] / radius, volume = size * size * size;
      per_mass = 1.0 / (mass * volume), per_inertia = 1.0 / (inertia * volume * size * size);
    }
    for (int k = 0; k < 3; ++k) {
      const double a = f[k] * per_mass + setup_.gravity[k], alpha = t[k] * per_inertia;
      v[k] += kick * a;
      w[k] += kick * alpha;
      x[k] += dt * v[k];
    }
  }
  work_->end_step(pair_->sums(), losses_);
}

void FixFurrow::grow_arrays(int most) {
  carried_.resize(most);
  listed_.resize(most);
}

void FixFurrow::copy_arrays(int from, int to, int) {
  if (from == to) return;
  carried_[to] = std::move(carried_[from]);
  carried_[from].clear();
  listed_[to] = listed_[from];
}

int FixFurrow::pack_exchange(int i, double* buffer) {
  const std::vector<Carried>& mine = carried_[i];
  if (mine.size() > kMostCarried) error->one(FLERR, "a grain touches more surfaces than it can carry along");
  buffer[0] = static_cast<double>(mine.size());
  if (!mine.empty()) std::memcpy(buffer + 1, mine.data(), mine.size() * sizeof(Carried));
  return 1 + static_cast<int>(mine.size()) * kCarriedSize;
}

int FixFurrow::unpack_exchange(int i, double* buffer) {
  const int count = static_cast<int>(buffer[0]);
  carried_[i].resize(count);
  if (count > 0) std::memcpy(static_cast<void*>(carried_[i].data()), buffer + 1, count * sizeof(Carried));
  return 1 + count * kCarriedSize;
}

}  // namespace furrow::terrain::liggghts
