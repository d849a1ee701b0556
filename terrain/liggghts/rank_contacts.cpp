#include "terrain/liggghts/rank_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/tires/surface_touch.hpp"
#include "terrain/surface/surface_check.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr double kRoom = 10.0;     // margin around a rank's grains for their motion in one interval, largest radii
constexpr double kFar = 1e6;       // farther than any wall, m; as in Bin::holds
constexpr int kPart = 256;         // grains per box
constexpr double kTireRoom = 1.0;  // by which a tire may move before grains near it are searched again, skins

using dem::ContactForce;
using dem::ContactHistory;
using dem::Quad;
using dem::Triple;

Triple<double> triple(const double* v) { return {v[0], v[1], v[2]}; }
Triple<double> triple(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
std::array<double, 3> array(const Triple<double>& v) { return {v.x, v.y, v.z}; }
void add(double* to, const Triple<double>& v) { to[0] += v.x, to[1] += v.y, to[2] += v.z; }

ContactHistory<double> history_of(const Carried& c) {
  return {triple(c.tangential), c.root_overlap, triple(c.rolling)};
}

/// False for a position that is not a number.
bool inside(const SurfaceBox& box, const double* x) {
  return x[0] > box.lo.x() && x[0] < box.hi.x() && x[1] > box.lo.y() && x[1] < box.hi.y() && x[2] > box.lo.z() &&
         x[2] < box.hi.z();
}

Carried carried_of(int partner, const Triple<double>& normal, const ContactHistory<double>& h) {
  return {static_cast<double>(partner), array(normal), array(h.tangential), h.root_overlap, array(h.rolling)};
}

}  // namespace

RankContacts::RankContacts(const dem::DemOptions& options)
    : options_(options),
      params_(dem::solver_params(options)),
      energies_(params_.sample_every),
      walls_(params_.bin, params_.grain.radius) {
  set_step(options.step);
}

EngineSetup RankContacts::setup() const {
  EngineSetup s;
  s.bin = params_.bin;
  s.skin = params_.skin;
  s.largest = params_.largest_radius();
  s.law = params_.law;
  s.rolling = params_.rolling;
  s.sizes = params_.sizes();
  s.grain = params_.grain;
  s.gravity = {params_.gravity.x(), params_.gravity.y(), params_.gravity.z()};
  return s;
}

void RankContacts::set_step(double dt) {
  coefficients_ = dem::run_coefficients(options_, dt);
  options_.step = dt;
  for (Tire& tire : tires_) tire.coefficients = dem::surface_coefficients(options_, tire.material, dt);
}

void RankContacts::attach(const SurfaceMesh& mesh, const ContactMaterial& material, const SurfaceState& start) {
  tires_.emplace_back(mesh, params_.largest_radius() + look_room(), options_.contact_tangents, params_.grain, material,
                      start);
  tires_.back().coefficients = dem::surface_coefficients(options_, material, options_.step);
  tires_roll_ |= material.rolling_friction > 0.0;
}

void RankContacts::begin_interval(std::span<const SurfaceState> targets, double duration, int steps) {
  FURROW_ASSERT(targets.size() == tires_.size() && steps > 0, targets.size(), tires_.size(), steps);
  SurfaceBox grains = box_;
  const double room = kRoom * params_.largest_radius();
  grains.lo.array() -= room, grains.hi.array() += room;
  for (std::size_t k = 0; k < tires_.size(); ++k) {
    Tire& tire = tires_[k];
    tire.way = tire.set_target(targets[k], duration) / steps;
    tire.collider.restrict_to(grains);
  }
  steps_ = steps;
  step_ = 0;
  interval_ = {};
}

void RankContacts::lists_made(const OwnGrains& grains, std::span<const std::int32_t> order) {
  order_ = order;
  looked_ = walls_listed_ = false;
  box_ = {Vec3::Constant(-kFar), Vec3::Constant(kFar)};  // grains may come to an empty rank from anywhere
  parts_.clear();
  if (grains.count == 0) return;
  for (int first = 0; first < grains.count; first += kPart) {
    Vec3 lo = Vec3::Constant(1e300), hi = -lo;
    for (int place = first; place < std::min(first + kPart, grains.count); ++place)
      for (int axis = 0; axis < 3; ++axis) {
        const double x = grains.position[order[place]][axis];
        lo[axis] = std::min(lo[axis], x), hi[axis] = std::max(hi[axis], x);
      }
    parts_.push_back({lo, hi});
  }
  box_ = parts_.front();
  for (const SurfaceBox& part : parts_) box_ = {box_.lo.cwiseMin(part.lo), box_.hi.cwiseMax(part.hi)};
}

StepWish RankContacts::begin_step() {
  for (Tire& tire : tires_) {
    tire.move_to(static_cast<double>(step_) / steps_, params_.largest_radius());
    tire.moved += tire.way;
    tire.forces.clear();
  }
  now_ = {};
  on_grains_.setZero();
  return {energies_.due(), step_ + 1 == steps_};
}

void RankContacts::numbers_change(const OwnGrains& grains) {
  walls_.hand_back(grains);
  forget_grains();
}

void RankContacts::forget_grains() {
  walls_.forget();
  touchable_.clear();
  numbered_ = looked_ = walls_listed_ = false;
}

void RankContacts::add_forces(const OwnGrains& grains, int first, int last, bool losses) {
  if (first == 0) look(grains);
  dem::with_law(params_.law, params_.rolling || tires_roll_, params_.sizes(), [&](auto law, auto rolling, auto sizes) {
    add_forces_of<decltype(law), rolling, sizes>(grains, last, losses);
  });
}

template <class Law, bool kRolling, bool kSizes>
void RankContacts::add_forces_of(const OwnGrains& grains, int last, bool losses) {
  WallContacts::Findings found;
  walls_.add_forces<Law, kRolling, kSizes>(grains, last, {coefficients_, times_.since, losses}, now_, found);
  if (found.lost >= 0) note_lost(grains, found.lost);
  if (found.hardest >= 0) note(found.overlap, found.share, grains.position[found.hardest]);
  const std::size_t touchable = touchable_.size();
  for (; next_ < touchable && touchable_[next_].place < last; ++next_)
    touch_tires<Law, kRolling>(grains, touchable_[next_], losses);
}

/// Reads a grain's histories only if the grain touches a tire, or did so in the previous step.
template <class Law, bool kRolling>
void RankContacts::touch_tires(const OwnGrains& grains, Touchable& t, bool losses) {
  const double* const x = grains.position[t.grain];
  const double r = grains.radius[t.grain];
  CarriedList& mine = grains.carried[t.grain];
  bool begun = false;
  const auto begin = [&] {
    past_.assign(mine.begin(), mine.end());
    mine.clear();
    taken_.assign(past_.size(), 0);
    begun = true;
  };
  std::array<SurfaceHit, kMaxSurfaceHits> hits;
  for (int k = 0; k < tires(); ++k) {
    if (!inside(tires_[k].near, x)) continue;
    const int* const begin_of = &near_begin_[t.near + k];
    const std::span<const int> among(near_.data() + begin_of[0], near_.data() + begin_of[1]);
    const int count = tires_[k].collider.hits({x[0], x[1], x[2]}, r, among, hits);
    if (count == 0) continue;
    if (!begun) begin();
    touch_tire<Law, kRolling>(grains, t.grain, k, std::span(hits).first(count), losses);
  }
  if (!begun && !t.carries) return;
  if (!begun) begin();
  t.carries = !mine.empty();
  if (!losses) return;
  for (std::size_t p = 0; p < past_.size(); ++p) {
    if (taken_[p]) continue;
    const Tire& tire = tires_[static_cast<int>(past_[p].partner) - dem::kWalls];
    now_.sample.power.opening +=
        Law::held(tire.against<Law>(params_.grain.radius, r), 0.0, history_of(past_[p])).tangential / times_.since;
  }
}

void RankContacts::note_lost(const OwnGrains& grains, int g) {
  const double* const x = grains.position[g];
  if (interval_.lost < 0.0) interval_.lost = grains.id[g] - 1, interval_.lost_at = {x[0], x[1], x[2]};
}

/// Finds grains that may touch a wall or a tire, as most touch only each other. Between two makings of the lists a
/// grain is at most a skin from its present position: half a skin on either side of its position when lists were made.
void RankContacts::look(const OwnGrains& grains) {
  if (!walls_listed_) {
    if (const auto lost = walls_.list(grains, order_, params_.skin)) note_lost(grains, *lost);
    walls_listed_ = true;
  }
  walls_.begin();
  next_ = 0;
  if (looked_far_enough()) return;
  const double room = look_room();
  for (Tire& t : tires_) {
    t.moved = 0.0;
    t.grid = t.collider.grid_rebuilds();
    t.looked_for.lo = t.near.lo.array() - room, t.looked_for.hi = t.near.hi.array() + room;
  }
  // Grains with a history of a tire were found before, unless the indices of grains have changed since.
  bool all = !numbered_;
  carries_.assign(grains.count, 0);
  for (int g = 0; g < grains.count && !numbered_; ++g) carries_[g] = !grains.carried[g].empty();
  for (const Touchable& t : touchable_) {
    if (!t.carries || !numbered_) continue;
    carries_[t.grain] = 1;
    all |= std::none_of(tires_.begin(), tires_.end(),
                        [x = grains.position[t.grain]](const Tire& tire) { return inside(tire.looked_for, x); });
  }
  touchable_.clear(), near_.clear(), near_begin_.clear();
  for (int first = 0; first < grains.count; first += kPart)
    if (all || any_near(parts_[first / kPart])) look_at(grains, first, std::min(first + kPart, grains.count));
  numbered_ = looked_ = true;
}

/// Whether grains that were in this box when lists were made may now be where grains near a tire are searched.
bool RankContacts::any_near(const SurfaceBox& part) const {
  const double way = params_.skin;
  return std::any_of(tires_.begin(), tires_.end(), [&](const Tire& t) {
    return (part.lo.array() - way <= t.looked_for.hi.array()).all() &&
           (part.hi.array() + way >= t.looked_for.lo.array()).all();
  });
}

void RankContacts::look_at(const OwnGrains& grains, int first, int last) {
  const double room = look_room();
  for (int place = first; place < last; ++place) {
    const int g = order_[place];
    const double* const x = grains.position[g];
    const bool carries = carries_[g] != 0;
    bool beside = carries;
    for (const Tire& t : tires_) beside |= inside(t.looked_for, x);
    if (!beside) continue;
    const std::size_t before = near_.size(), begin = near_begin_.size();
    for (const Tire& t : tires_) {
      near_begin_.push_back(static_cast<int>(near_.size()));
      t.collider.near({x[0], x[1], x[2]}, grains.radius[g] + room, near_);
    }
    near_begin_.push_back(static_cast<int>(near_.size()));
    if (carries || near_.size() > before)
      touchable_.push_back({place, g, static_cast<int>(begin), carries});
    else
      near_begin_.resize(begin);
  }
}

double RankContacts::look_room() const { return (1.0 + kTireRoom) * params_.skin; }

bool RankContacts::looked_far_enough() const {
  return looked_ && std::all_of(tires_.begin(), tires_.end(), [&](const Tire& t) {
           return t.moved <= kTireRoom * params_.skin && t.grid == t.collider.grid_rebuilds();
         });
}

void RankContacts::note(double overlap, double share, const double* at) {
  now_.max_overlap = std::max(now_.max_overlap, overlap);
  if (share > interval_.share) interval_.share = share, interval_.hardest_at = {at[0], at[1], at[2]};
}

template <class Law, bool kRolling>
void RankContacts::touch_tire(const OwnGrains& grains, int g, int k, std::span<const SurfaceHit> hits, bool losses) {
  Tire& tire = tires_[k];
  const double r = grains.radius[g];
  const Vec3 centre(grains.position[g][0], grains.position[g][1], grains.position[g][2]);
  const int partner = dem::kWalls + k;
  const auto c = tire.against<Law>(params_.grain.radius, r);
  const Triple<double> v = triple(grains.velocity[g]), w = triple(grains.spin[g]);
  for (const SurfaceHit& hit : hits) {
    const Triple<double> arm = dem::triple(Vec3(hit.point - centre));
    const auto patch = tire.patch_at(hit, kRolling && c.rolling_arm > 0.0);
    const dem::ContactMotion<double> motion = dem::motion_at(tire.collider, patch ? &*patch : nullptr, hit, arm, v, w);
    ContactHistory<double> history{{0, 0, 0}, 0.0, {0, 0, 0}};
    double cosine = dem::kSameNormal;
    int nearest = -1;
    for (std::size_t p = 0; p < past_.size(); ++p) {
      if (static_cast<int>(past_[p].partner) != partner) continue;
      const double same = dot(triple(past_[p].normal), motion.normal);
      if (same > cosine) cosine = same, nearest = static_cast<int>(p);
    }
    if (nearest >= 0) history = history_of(past_[nearest]), taken_[nearest] = 1;
    if (losses) add(now_.sample, dem::sample_of<Law, kRolling>(c, times_.since, motion, history), hit.share);
    const ContactForce<double> f = Law::template force<kRolling>(c, times_.since, motion, history);
    if constexpr (Law::kHistory) grains.carried[g].push_back(carried_of(partner, motion.normal, history));
    const auto [push, drag, torque] = dem::facet_loads(f, motion.normal, arm, hit.share);
    add(grains.force[g], push + drag);
    add(grains.torque[g], torque);
    tire.forces.push_back(
        {hit.triangle, hit.weight, hit.point, -dem::vec(push), -dem::vec(drag), {}, {}, dem::slides(c, f)});
    if (patch) tire.forces.back().couple = patch->couple(-hit.share * dem::vec(f.rolling));
    if (options_.contact_tangents) tire.forces.back().tangent = dem::contact_tangent<Law>(c, motion, f, hit.share);
    on_grains_ += dem::vec(push + drag);
    now_.elastic += hit.share * f.energy;
    ++now_.contacts;
    note(hit.overlap, 0.5 * hit.overlap / r, grains.position[g]);
  }
}

std::vector<CarriedBy> RankContacts::carried(const OwnGrains& grains) const {
  std::vector<CarriedBy> all;
  for (int g = 0; g < grains.count; ++g)
    for (const Carried& c : grains.carried[g]) all.push_back({g, c});
  walls_.for_touching([&](int g, const Carried& c) { all.push_back({g, c}); });
  std::stable_sort(all.begin(), all.end(), [](const CarriedBy& a, const CarriedBy& b) {
    return std::pair(a.grain, a.contact.partner) < std::pair(b.grain, b.contact.partner);
  });
  for (CarriedBy& one : all) one.grain = grains.id[one.grain] - 1;
  return all;
}

void RankContacts::sum_motion(const OwnGrains& grains) {
  sums_.motion = {};
  for (int g = 0; g < grains.count; ++g) {
    const double size = grains.radius[g] / params_.grain.radius, volume = size * size * size;
    sums_.motion.add(grains.position[g], grains.velocity[g], grains.spin[g], volume, volume * size * size);
  }
}

void RankContacts::end_step(const PairSums& pairs, const MotionSums& motion, bool losses) {
  const double dt = times_.kick;
  for (Tire& tire : tires_) tire.sum.add_substep(tire.forces, tire.collider, dt, times_.dt);
  sums_.elastic = pairs.elastic + now_.elastic;
  sums_.wall_impulse += dt * Vec3(now_.wall_force.x, now_.wall_force.y, now_.wall_force.z);
  sums_.surface_impulse += dt * on_grains_;
  sums_.gravity_time += dt;
  sums_.floor_force = now_.floor_force;
  sums_.contacts = pairs.contacts + static_cast<double>(now_.contacts);
  interval_.overlap = std::max({interval_.overlap, pairs.max_overlap, now_.max_overlap});
  if (pairs.max_share > interval_.share)
    interval_.share = pairs.max_share, interval_.hardest_at = Vec3::Map(pairs.hardest_at.data());
  if (losses) {
    dem::ContactSample all = pairs.sample;
    add(all, now_.sample);
    energies_.sample(1, [&](int) { return &all; });
  }
  energies_.advance(dt, true, 0.0);
  if (++step_ == steps_) sums_.motion = motion;
}

void RankContacts::end_interval(double duration, std::span<NodalForces> forces, std::span<ContactSums> sums) {
  FURROW_ASSERT(forces.size() == tires_.size() && sums.size() == tires_.size(), forces.size(), sums.size());
  for (std::size_t k = 0; k < tires_.size(); ++k) {
    tires_[k].collider.move_to(1.0);
    tires_[k].sum.finish(duration, forces[k], sums[k]);
  }
}

void RankContacts::begin_accounts(const dem::Stored& stored, double elastic) {
  const MotionSums motion = sums_.motion;
  sums_ = {};
  sums_.motion = motion;
  sums_.elastic = elastic;
  energies_.begin({stored}, 0.0);
}

void RankContacts::save(Archive& archive) const {
  dem::save_surfaces(archive, "tire", tires_);
  save_fields(archive, "sums", sums_);
  energies_.save(archive);
}

void RankContacts::restore(const Archive& archive) {
  dem::restore_surfaces(archive, "tire", tires_, [this](const auto& mesh, const auto& material, const auto& start) {
    attach(mesh, material, start);
  });
  restore_fields(archive, "sums", sums_);
  energies_.restore(archive, 1);
}

}  // namespace furrow::terrain::liggghts
