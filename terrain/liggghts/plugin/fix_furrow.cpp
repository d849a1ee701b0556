#include "terrain/liggghts/plugin/fix_furrow.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <error.h>
#include <update.h>

#include "terrain/liggghts/plugin/grain_motion.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr int kCarriedSize = sizeof(Carried) / sizeof(double);
static_assert(kCarriedSize * sizeof(double) == sizeof(Carried));
constexpr int kPairSize = 1 + sizeof(PairHistory) / sizeof(double);
constexpr int kMostPairs = 256;  // of one grain
constexpr double kForever = std::numeric_limits<double>::infinity();

double distance2(const double* a, const std::array<double, 3>& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

}  // namespace

FixFurrow::FixFurrow(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg) : Fix(lmp, narg, arg) {
  time_integrate = 1;
  create_attribute = 1;
  force_reneighbor = 1;
  next_reneighbor = -1;
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  comm->maxexchange_fix += 2 + kMostCarried * kCarriedSize + kMostPairs * kPairSize;
}

FixFurrow::~FixFurrow() { atom->delete_callback(id, 0); }

int FixFurrow::setmask() {
  namespace when = LAMMPS_NS::FixConst;
  return when::PRE_EXCHANGE | when::PRE_NEIGHBOR | when::PRE_FORCE | when::FINAL_INTEGRATE;
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

/// The indices of grains change, so each grain takes its histories along, as either grain of an own pair may leave.
void FixFurrow::pre_exchange() {
  work_->numbers_change(this->own());
  PairLists& lists = pair_->lists();
  if (!lists.valid()) return;
  const int own = atom->nlocal;
  lists.for_touching([&](int i, int j, int entry) {
    const PairHistory h = lists.history(entry);
    pairs_[i].push_back({atom->tag[j], h});
    if (j < own) pairs_[j].push_back({atom->tag[i], h.turned()});
  });
  lists.drop();
}

void FixFurrow::note_exchange() {
  for (int i = 0; i < atom->nlocal; ++i) exchanged_[i] = {atom->x[i][0], atom->x[i][1], atom->x[i][2]};
}

void FixFurrow::pre_neighbor() {
  note_exchange();
  make_lists();
}

void FixFurrow::make_lists() {
  PairLists& lists = pair_->lists();
  const int own = atom->nlocal, all = own + atom->nghost;
  const bool numbered = lists.valid();
  lists.make({atom->x, atom->radius, own, all, domain->sublo[0], domain->subhi[0]});
  if (!numbered) {
    for (int row = 0; row < lists.rows(); ++row)
      for (const PairOf& pair : pairs_[lists.grain(row)])
        for (int e = lists.begin(row); e < lists.end(row); ++e)
          if (atom->tag[lists.partner()[e]] == pair.partner) lists.remember(e, pair.history);
    for (int i = 0; i < own; ++i) pairs_[i].clear();
  }
  for (int i = 0; i < all; ++i) listed_[i] = {atom->x[i][0], atom->x[i][1], atom->x[i][2]};
  way_ = 0.0;
  work_->lists_made(this->own(), lists.grains());
}

void FixFurrow::look_again() {
  double fastest2 = 0.0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const double* const v = atom->v[i];
    fastest2 = std::max(fastest2, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  fastest_ = std::sqrt(fastest2);
  way_ = kForever;
}

/// A position that is not a number counts as moved too far.
bool FixFurrow::lists_due() {
  const double limit2 = 0.25 * setup_.skin * setup_.skin;
  const int own = atom->nlocal, all = own + atom->nghost;
  for (int i = own; i < all; ++i)
    if (!(distance2(atom->x[i], listed_[i]) <= limit2)) return true;
  if (way_ * way_ <= limit2) return false;
  double most2 = 0.0;
  for (int i = 0; i < own; ++i) {
    const double d2 = distance2(atom->x[i], listed_[i]);
    if (!(d2 <= limit2)) return true;
    most2 = std::max(most2, d2);
  }
  way_ = std::sqrt(most2);
  return false;
}

/// Conditions (1) and (2).
bool FixFurrow::strayed() const {
  const double skin = setup_.skin, moves = 2.0 * fastest_ * times_.dt;
  const double outside = 0.5 * skin - moves, near = 2.0 * setup_.largest + 1.5 * skin + moves;
  const double sent = 2.0 * setup_.largest + (1.0 + kGhostRoom) * skin;
  const auto over = [&](int axis, bool low, bool high) {
    const double lo = low ? domain->sublo[axis] : -kForever, hi = high ? domain->subhi[axis] : kForever;
    for (int i = 0; i < atom->nlocal; ++i) {
      const double x = atom->x[i][axis], from = exchanged_[i][axis];
      if (!(x >= lo - outside && x <= hi + outside)) return true;
      if ((x < lo + near && from >= lo + sent) || (x > hi - near && from <= hi - sent)) return true;
    }
    return false;
  };
  const bool first = comm->myloc[0] == 0, last = comm->myloc[0] == comm->procgrid[0] - 1;
  return (comm->nprocs > 1 && over(0, !first, !last)) || (domain->yperiodic && over(1, true, true));
}

bool FixFurrow::exchange_due() const { return next_reneighbor == update->ntimestep + 1; }
void FixFurrow::set_exchange_due() { next_reneighbor = update->ntimestep + 1; }

void FixFurrow::pre_force(int) {
  int due = lists_due() ? 1 : 0, any_due = due;
  if (comm->nprocs > 1) MPI_Allreduce(&due, &any_due, 1, MPI_INT, MPI_MAX, world);
  asks_ = any_asks_ = 0;
  if (any_due) {
    make_lists();
    asks_ = any_asks_ = strayed() ? 1 : 0;
    if (comm->nprocs > 1) MPI_Iallreduce(&asks_, &any_asks_, 1, MPI_INT, MPI_MAX, world, &asking_);
  }
  wish_ = work_->begin_step();
  pair_->begin_step(*work_, own(), wish_.losses);
}

template <bool kSums, bool kSizes>
void FixFurrow::move() {
  const OwnGrains grains = own();
  MovingGrains moving;
  if (grains.count > 0)
    moving = {reinterpret_cast<double(*)[3]>(atom->x[0]),
              reinterpret_cast<double(*)[3]>(atom->v[0]),
              reinterpret_cast<double(*)[3]>(atom->omega[0]),
              grains.force,
              grains.torque,
              grains.radius};
  GrainMotion motion(setup_, times_);
  motion.move<kSums, kSizes>(moving, grains.count);
  fastest_ = motion.fastest();
  way_ += times_.dt * fastest_;
  if constexpr (kSums) sums_ = motion.sums();
}

void FixFurrow::final_integrate() {
  if (wish_.motion) {
    setup_.sizes ? move<true, true>() : move<true, false>();
  } else {
    setup_.sizes ? move<false, true>() : move<false, false>();
  }
  if (asking_ != MPI_REQUEST_NULL) MPI_Wait(&asking_, MPI_STATUS_IGNORE);
  if (any_asks_) set_exchange_due();
  work_->end_step(pair_->sums(), sums_, wish_.losses);
}

void FixFurrow::grow_arrays(int most) {
  carried_.resize(most);
  pairs_.resize(most);
  listed_.resize(most);
  exchanged_.resize(most);
}

void FixFurrow::copy_arrays(int from, int to, int) {
  if (from == to) return;
  carried_[to] = std::move(carried_[from]);
  carried_[from].clear();
  pairs_[to] = std::move(pairs_[from]);
  pairs_[from].clear();
}

int FixFurrow::pack_exchange(int i, double* buffer) {
  const CarriedList& mine = carried_[i];
  const std::vector<PairOf>& pairs = pairs_[i];
  if (mine.size() > kMostCarried) error->one(FLERR, "a grain touches more surfaces than it can carry along");
  if (pairs.size() > kMostPairs) error->one(FLERR, "a grain touches more grains than it can carry along");
  double* to = buffer;
  *to++ = static_cast<double>(mine.size());
  *to++ = static_cast<double>(pairs.size());
  if (!mine.empty()) std::memcpy(to, mine.data(), mine.size() * sizeof(Carried));
  to += mine.size() * kCarriedSize;
  for (const PairOf& pair : pairs) {
    *to++ = pair.partner;
    std::memcpy(to, &pair.history, sizeof pair.history);
    to += kPairSize - 1;
  }
  return static_cast<int>(to - buffer);
}

int FixFurrow::unpack_exchange(int i, double* buffer) {
  const double* from = buffer;
  carried_[i].resize(static_cast<std::size_t>(*from++));
  pairs_[i].resize(static_cast<std::size_t>(*from++));
  if (!carried_[i].empty())
    std::memcpy(static_cast<void*>(carried_[i].data()), from, carried_[i].size() * sizeof(Carried));
  from += carried_[i].size() * kCarriedSize;
  for (PairOf& pair : pairs_[i]) {
    pair.partner = static_cast<std::int32_t>(*from++);
    std::memcpy(static_cast<void*>(&pair.history), from, sizeof pair.history);
    from += kPairSize - 1;
  }
  return static_cast<int>(from - buffer);
}

}  // namespace furrow::terrain::liggghts
