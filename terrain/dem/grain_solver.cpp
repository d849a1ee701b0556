#include "terrain/dem/grain_solver.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <omp.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/accounts/stored_energy.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr int kChunks = 64;     // with strips to evaluate, for load balance
constexpr int kMaxStrips = 12;  // of a chunk, so that its data stay in the cache of its thread
constexpr int kMinStrips = 6;   // of a chunk, as its first strip is moved only in the second pass

Strips::Options strip_options(const SolverParams& p) {
  Strips::Options o;
  o.reach = 2.0 * p.largest_radius() + p.skin;
  o.skin = p.skin;
  o.history = has_history(p.law);
  o.rolling = p.rolling;
  o.single = p.precision == Precision::mixed;
  o.cut = p.activity;
  o.bin = p.bin;
  return o;
}

Vec3 against(const Vec3& gravity) {
  const double strength = gravity.norm();
  return strength > 0.0 ? Vec3(-gravity / strength) : Vec3(Vec3::UnitZ());
}

template <class T>
void grow(std::vector<T>& v, std::size_t n) {
  if (v.size() < n) v.resize(n + n / 4);
}

}  // namespace

GrainSolver::GrainSolver(const SolverParams& params)
    : params_(params),
      up_(against(params.gravity)),
      strips_(strip_options(params)),
      surfaces_(params.grain, params.largest_radius(), params.law, params.rolling),
      energies_(params.sample_every) {
  FURROW_ASSERT(params.grain.radius > 0.0, params.grain.radius);
  FURROW_ASSERT(params.grain.mass > 0.0 && params.grain.inertia > 0.0, params.grain.mass, params.grain.inertia);
  FURROW_ASSERT(params.bin.length > 0.0 && params.bin.width > 0.0, params.bin.length, params.bin.width);
  FURROW_ASSERT(params.skin >= 0.0 && params.gravity.allFinite(), params.skin, params.gravity.norm());
  FURROW_ASSERT(params.threads > 0, params.threads);
  FURROW_ASSERT(!params.sizes() || params.smallest > 0.0, params.smallest, params.largest);
  FURROW_ASSERT(!params.sizes() || has_sizes(params.law), params.smallest, params.largest);
}

/// Cuts the bin into chunks whose length follows from the strips that a step evaluates, not from the threads.
void GrainSolver::make_chunks() {
  const int n = strips_.count();
  int evaluated = 0;
  for (int k = 0; k < n; ++k) evaluated += activity_.evaluated(k) ? 1 : 0;
  const int each = std::clamp((evaluated + kChunks - 1) / kChunks, kMinStrips, kMaxStrips);
  chunks_.resize((n + each - 1) / each);
  int from = 0;
  for (Chunk& chunk : chunks_) {
    chunk.from = from;
    chunk.to = from = std::min(from + each, n);
  }
}

void GrainSolver::place(const std::vector<Quad>& positions) {
  grains_.resize(static_cast<int>(positions.size()), params_.activity);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Quad& p = grains_.position[i] = positions[i];
    if (p.w == 0.0) p.w = params_.grain.radius;
    if (!(p.w >= params_.smallest_radius() && p.w <= params_.largest_radius()))
      throw Error(ExitCode::bad_input, fmt::format("grain {} has radius {:g} m, expected {:g} to {:g} m", i, p.w,
                                                   params_.smallest_radius(), params_.largest_radius()));
  }
  surfaces_.resize(strips_.count());
  overlap_bound_.clear();
  strips_.rebuild_all(grains_, params_.threads);
  reset_accounts();
}

int GrainSolver::index_of(int id) const {
  FURROW_ASSERT(in_range(id, grains_.count), id, grains_.count);
  return static_cast<int>(std::find(grains_.id.begin(), grains_.id.end(), id) - grains_.id.begin());
}

double GrainSolver::rebuilds() const { return static_cast<double>(strips_.resorted()) / std::max(1, grains_.count); }

/// @pre the buffer has at least `last` entries
void GrainSolver::LoadBuffer::copy(const Loads& from, int first, int last) {
  FURROW_ASSERT(0 <= first && first <= last && static_cast<std::size_t>(last) <= force.size(), first, last,
                force.size());
  FURROW_ASSERT(from.force != nullptr || first == last, first, last);
  std::copy(from.force + first, from.force + last, force.begin() + first);
  std::copy(from.torque + first, from.torque + last, torque.begin() + first);
}

template <>
GrainSolver::Scratch<float>& GrainSolver::scratch() {
  return single_[omp_get_thread_num()];
}
template <>
GrainSolver::Scratch<double>& GrainSolver::scratch() {
  return full_[omp_get_thread_num()];
}

/// Copies the motion of the grains of a strip that a step needs to `offset` of the scratch memory; clears their loads.
template <class Real, bool kSizes>
void GrainSolver::gather(Scratch<Real>& s, int strip, int offset) {
  FURROW_ASSERT(in_range(strip, strips_.count()) && offset >= 0, strip, strips_.count(), offset);
  FURROW_ASSERT(s.loads.force.size() >= static_cast<std::size_t>(offset + strips_[strip].grains()),
                s.loads.force.size(), offset);
  activity_.each_row(strip, Activity::kMotion, [&](int from, int to) {
    const StripPart part = joined(strips_[strip].parcels, from, to);
    const int first = strips_[strip].first + part.first, n = part.grains(), at = offset + part.first;
    if (n == 0) return;
    s.motion.template set<kSizes>(at, &grains_.position[first], &grains_.velocity[first], &grains_.spin[first], n);
    double* const force = flat(s.loads.force.data() + at);
    double* const torque = flat(s.loads.torque.data() + at);
    for (int g = 0; g < kQuad * n; g += kQuad) {  // a call of memset would cost more than it saves
      store_lanes(force + g, Double4{});
      store_lanes(torque + g, Double4{});
    }
  });
}

template <class Real>
const Quad* GrainSolver::positions(Scratch<Real>& s, int k) {
  const Strip& strip = strips_[k];
  const Quad* const x = grains_.position.data() + strip.first;
  const int after = strips_.next(k);
  if (after < 0 || after >= k) return x;
  const Strip& other = strips_[after];
  grow(s.shifted, strip.grains() + other.grains());
  std::copy_n(x, strip.grains(), s.shifted.begin());
  for (int g = 0; g < other.grains(); ++g) {
    Quad p = grains_.position[other.first + g];
    p.x += params_.bin.length;
    s.shifted[strip.grains() + g] = p;
  }
  return s.shifted.data();
}

template <class Real, class Law, bool kRolling, bool kSizes>
void GrainSolver::contacts_of_part(Scratch<Real>& s, int k, const StripPart& part, const Quad* x, int offset, double dt,
                                   Wanted wanted, ContactTotals& sums) {
  Strip& strip = strips_[k];
  const double diameter = 2.0 * params_.grain.radius;
  const double reference = params_.grain.radius;
  find_touching<kSizes>(strip, part.pair_first, part.pair_last, x, diameter,
                        params_.bin.periodic_y ? params_.bin.width : 0.0, s.touching, [&](int p) {
                          if (!wanted.losses) return;
                          const double r_i = kSizes ? x[strip.grain_i(p)].w : reference,
                                       r_j = kSizes ? x[strip.grain_j(p)].w : reference;
                          const auto c = sized_pair<Law>(coefficients_.pair.of<Law>(), reference, r_i, r_j);
                          sums.sample.power.opening += Law::held(c, 0.0, pair_history(strip, p)).tangential / dt;
                        });
  PairLaw<Law, Real> law;
  law.coefficients = coefficients_.pair.of<Law, Real>();
  law.diameter = static_cast<Real>(diameter);
  law.per_radius = static_cast<Real>(1.0 / params_.grain.radius);
  law.step = static_cast<Real>(dt);
  law.wanted = wanted;
  const Loads loads{s.loads.force.data() + offset, s.loads.torque.data() + offset};
  const Motion motion{flat(s.motion.v.data()) + kQuad * offset,
                      s.motion.w.empty() ? nullptr : flat(s.motion.w.data()) + kQuad * offset};
  PairForces<Law, kRolling, kSizes, Real>(law, s.touching, motion, strip.history<Real>(), loads).run(sums);
  wall_forces<Law, kRolling, kSizes>(grains_, strip, part.wall_first, part.wall_last, params_.bin, params_.grain.radius,
                                     coefficients_, dt, wanted, loads, sums);
}

template <class Real, class Law, bool kRolling, bool kSizes>
void GrainSolver::contacts_of_strip(Scratch<Real>& s, int k, int offset, double dt, Wanted wanted) {
  FURROW_ASSERT(in_range(k, strips_.count()) && offset >= 0, k, strips_.count(), offset);
  Strip& strip = strips_[k];
  std::vector<Parcel>& parcels = strip.parcels;
  const Quad* const x = positions(s, k);
  const Loads loads{s.loads.force.data() + offset, s.loads.torque.data() + offset};
  const auto of_part = [&](const StripPart& part, Wanted what, ContactTotals& sums) {
    contacts_of_part<Real, Law, kRolling, kSizes>(s, k, part, x, offset, dt, what, sums);
    if (surfaces_.any()) surfaces_.evaluate(grains_, strip, k, part.first, part.last, dt, wanted.losses, loads, sums);
  };
  const auto alone = [&](int p) {
    return parcels[p].asleep || (params_.activity && Activity::about_to_sleep(parcels[p]));
  };
  if (surfaces_.any()) surfaces_.begin(k, wanted.losses);
  ContactTotals awake;
  activity_.each_row(
      k, Activity::kList, [&](int p) { return !alone(p); },
      [&](int from, int to) {
        if (!alone(from)) return of_part(joined(parcels, from, to), wanted, awake);
        // A parcel that falls asleep in a step without measurements would otherwise have no sums of its own.
        const bool all = parcels.size() > 1 && !parcels[from].asleep;
        const Wanted what{.forces = wanted.forces || all, .losses = wanted.losses || all};
        parcels[from].contact = {};
        of_part(parcels[from].part, what, parcels[from].contact);
        if (what.forces) parcels[from].measured_force = parcels[from].contact.contact_force;
        if (what.losses) parcels[from].stored = parcels[from].contact.sample.stored;
      });
  strip.contact = awake;
  for (std::size_t p = 0; p < parcels.size(); ++p) {
    if (!alone(static_cast<int>(p))) continue;
    ContactTotals now = parcels[p].contact;
    if (!activity_.needs(k, static_cast<int>(p), Activity::kList)) {
      now.power = 0.0;
      now.contact_force = parcels[p].measured_force;
      now.sample = {{}, parcels[p].stored};
    }
    parcels.size() == 1 ? void(strip.contact = now) : add(strip.contact, now);
  }
  if (surfaces_.any()) surfaces_.end(grains_, k, dt, wanted.losses, strip.contact);
}

template <class Real, class Law, bool kRolling, bool kSizes>
void GrainSolver::run_chunk(Chunk& chunk, const StepPart& part, Wanted wanted) {
  FURROW_ASSERT(chunk.from < chunk.to && chunk.to <= strips_.count(), chunk.from, chunk.to, strips_.count());
  Scratch<Real>& s = scratch<Real>();
  const int first = strips_[chunk.from].first, last = strips_[chunk.to - 1].last;
  const int beyond = strips_.next(chunk.to - 1);
  const int ahead = beyond < 0 ? 0 : strips_[beyond].grains();
  s.motion.grow(last - first + ahead);
  grow(s.loads.force, last - first + ahead);
  grow(s.loads.torque, last - first + ahead);
  const Loads all{s.loads.force.data(), s.loads.torque.data()};
  // Copies the loads of the parcels of strip k whose loads are complete.
  const auto keep_loads = [&](LoadBuffer& buffer, int k, int offset) {
    grow(buffer.force, strips_[k].grains());
    grow(buffer.torque, strips_[k].grains());
    activity_.each_row(k, Activity::kLoads, [&](int from, int to) {
      const StripPart row = joined(strips_[k].parcels, from, to);
      buffer.copy(all.from(offset), row.first, row.last);
    });
  };
  bool gathered = false;  // whether the previous strip has gathered strip k
  for (int k = chunk.from; k < chunk.to; ++k) {
    Strip& strip = strips_[k];
    const int offset = strip.first - first;
    const bool evaluated = activity_.evaluated(k);
    if (!gathered) gather<Real, kSizes>(s, k, offset);
    gathered = false;
    if (evaluated) {
      if (const int next = strips_.next(k); next >= 0)
        gather<Real, kSizes>(s, next, strip.last - first), gathered = true;
      contacts_of_strip<Real, Law, kRolling, kSizes>(s, k, offset, part.since, wanted);
    } else {
      strip.contact.power = strip.motion.step_work = 0.0;
    }
    if (!activity_.complete(k)) continue;
    if (k == chunk.from) {
      keep_loads(chunk.own, k, offset);
    } else {
      finish_strip(k, all.from(offset), part, wanted);
    }
  }
  if (gathered && activity_.complete(beyond)) keep_loads(chunk.ahead, beyond, last - first);
}

void GrainSolver::finish_chunk(Chunk& chunk, const Chunk* before, const StepPart& part, Wanted wanted) {
  if (!activity_.complete(chunk.from)) return;
  if (before)
    activity_.each_row(chunk.from, Activity::kLoads, [&](int from, int to) {
      const StripPart row = joined(strips_[chunk.from].parcels, from, to);
      for (int g = row.first; g < row.last; ++g) {
        add(chunk.own.force[g], load(before->ahead.force[g]));
        add(chunk.own.torque[g], load(before->ahead.torque[g]));
      }
    });
  finish_strip(chunk.from, {chunk.own.force.data(), chunk.own.torque.data()}, part, wanted);
}

void GrainSolver::finish_strip(int k, const Loads& loads, const StepPart& part, Wanted wanted) {
  FURROW_ASSERT(in_range(k, strips_.count()), k, strips_.count());
  FURROW_ASSERT(loads.force != nullptr || strips_[k].grains() == 0, k, strips_[k].grains());
  Strip& strip = strips_[k];
  activity_.each_row(k, Activity::kLoads, [&](int from, int to) {
    for (int p = from; p < to; ++p) {
      Parcel& parcel = strip.parcels[p];
      parcel.stale = false;
      if (parcel.asleep) {
        load_sleeper(strip, parcel, loads.from(parcel.part.first));
      } else {
        move_parcel(strip, parcel, loads.from(parcel.part.first), part, wanted);
      }
    }
  });
  strip.stale = false;
  strips_.sum_parcels(k);
  if (!strip.asleep) strip.travel += part.dt * strip.motion.max_speed;
}

/// A contact with overlap δ when the forces were evaluated has at most δ + dt (v_i + v_j) now; for a pair that did not
/// touch δ = 0. The same holds for a surface, with its speed.
void GrainSolver::bound_overlaps(double dt) {
  overlap_bound_.resize(strips_.count());
  for (int k = 0; k < strips_.count(); ++k) {
    const Strip& strip = strips_[k];
    const int next = strips_.next(k);
    const double own = strip.motion.max_speed, other = next < 0 ? 0.0 : strips_[next].motion.max_speed;
    double speed = own + (own > other ? own : other);
    if (surfaces_.any()) speed += surfaces_.speed_near(strip);
    overlap_bound_[k] = strip.contact.max_overlap + dt * speed;
  }
}

void GrainSolver::spread_bounds(const Resorted& range) {
  const int from = std::max(range.from - 1, 0), to = std::min(range.to + 1, strips_.count());
  double most = 0.0;
  for (int k = from; k < to; ++k)
    if (!(overlap_bound_[k] <= most)) most = overlap_bound_[k];
  std::fill(overlap_bound_.begin() + from, overlap_bound_.begin() + to, most);
}

double GrainSolver::top() const {
  double top = 0.0;
  for (int k = 0; k < strips_.count(); ++k)
    if (strips_[k].grains() > 0) top = std::max(top, strips_[k].z_max + strips_[k].travel);
  return top + params_.largest_radius();
}

template <class Real>
void GrainSolver::evaluate(const StepPart& part, Wanted wanted) {
  with_law(params_.law, params_.rolling, params_.sizes(), [&](auto law, auto rolling, auto sizes) {
    const int count = static_cast<int>(chunks_.size());
#pragma omp parallel for num_threads(params_.threads) schedule(dynamic, 1)
    for (int c = 0; c < count; ++c)
      run_chunk<Real, decltype(law), decltype(rolling)::value, decltype(sizes)::value>(chunks_[c], part, wanted);
  });
}

int GrainSolver::step_part(const StepPart& part, bool measure) {
  FURROW_ASSERT(part.dt > 0.0 && std::isfinite(part.dt) && part.since > 0.0, part.dt, part.since);
  FURROW_ASSERT(part.whole >= part.dt && (part.last || part.whole > part.dt), part.dt, part.whole);
  FURROW_ASSERT(grains_.position.size() == static_cast<std::size_t>(grains_.count + Grains::kBeyond),
                grains_.position.size());
  const auto threads = static_cast<std::size_t>(std::max(1, params_.threads));
  const bool sample = sample_now();
  const Wanted wanted{.forces = measure || sample, .losses = energies_.due()};
  if (activity_.plan(strips_, sway_steps(part.whole))) make_chunks();
  if (params_.precision == Precision::mixed) {
    if (single_.size() < threads) single_.resize(threads);
    evaluate<float>(part, wanted);
  } else {
    if (full_.size() < threads) full_.resize(threads);
    evaluate<double>(part, wanted);
  }
  if (surfaces_.any()) accounts_.surface_impulse += surfaces_.add_substep_forces(part.kick(), part.dt);

  const int count = static_cast<int>(chunks_.size());
#pragma omp parallel for num_threads(params_.threads) schedule(dynamic, 1)
  for (int c = 0; c < count; ++c) {
    const Chunk* const before = c > 0 ? &chunks_[c - 1] : params_.bin.periodic_x ? &chunks_[count - 1] : nullptr;
    finish_chunk(chunks_[c], before, part, wanted);
  }
  reduce(part, wanted);
  if (sample) take_samples();
  if (params_.activity && part.last) --until_sample_;
  bound_overlaps(part.dt);
  change_activity(part.last);
  // A grain that is not finite or moved far is found when its strip is sorted, one that slips out when its wall pushes.
  for (const Resorted& range : strips_.rebuild_moved(grains_, part.whole, params_.threads)) {
    spread_bounds(range);
    surfaces_.reorder(range, strips_);
    Activity::wake_moving(range, strips_, grains_);
  }
  for (int k = 0; k < strips_.count(); ++k)
    if (strips_[k].lost >= 0) return strips_[k].first + strips_[k].lost;
  return -1;
}

}  // namespace furrow::terrain::dem
