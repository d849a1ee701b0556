#include "terrain/dem/grain_solver.hpp"

#include <algorithm>
#include <cmath>

#include <omp.h>

namespace furrow::dem {
namespace {

/// Lists the pairs p in [from, to) that touch, remembers which, and clears what a separated pair leaves behind.
int filter(PairBlock& block, const Grains& grains, int from, int to, double diameter, std::int32_t* out) {
  const Lane limit = splat(diameter * diameter);
  const Quad* x = grains.position.data();
  int count = 0;
  for (int p = from; p < to; p += kLanes) {
    const std::int32_t *i = &block.i[p], *j = &block.j[p];
    const Triple<Lane> d = transpose(load(x[i[0]]) - load(x[j[0]]), load(x[i[1]]) - load(x[j[1]]),
                                     load(x[i[2]]) - load(x[j[2]]), load(x[i[3]]) - load(x[j[3]]));
    const LaneMask hit = dot(d, d) < limit;
    const int now = static_cast<int>((hit[0] & 1) | (hit[1] & 2) | (hit[2] & 4) | (hit[3] & 8));
    std::uint8_t& before = block.touching[p / kLanes];
    if (const int ended = before & ~now; ended != 0)
      for (int k = 0; k < kLanes; ++k)
        if (ended >> k & 1) {
          if (!block.tangential.empty()) block.tangential[p + k] = {};
          if (!block.rolling.empty()) block.rolling[p + k] = {};
          if (p < block.inner) continue;
          block.slot_force[p + k - block.inner] = block.slot_torque[p + k - block.inner] = {};
        }
    before = static_cast<std::uint8_t>(now);
    for (int k = 0; k < kLanes; ++k) {
      out[count] = p + k;
      count += now >> k & 1;
    }
  }
  return count;
}

/// Running sums over lanes.
struct LaneSums {
  Lane power{}, elastic{}, overlap{}, force{};
  void add_to(BlockSums& sums) const {
    sums.power += sum_of(power);
    sums.elastic += sum_of(elastic);
    sums.contact_force += sum_of(force);
    for (int k = 0; k < kLanes; ++k) sums.max_overlap = std::max(sums.max_overlap, overlap[k]);
  }
};

void add(Quad& q, Lane v) { store(q, load(q) + v); }

}  // namespace

GrainSolver::GrainSolver(const SolverParams& params)
    : params_(params),
      pairs_({params.grain.radius, params.skin, params.law == LawKind::mindlin, params.rolling, params.bin}),
      surfaces_(params.grain, params.rolling) {}

void GrainSolver::place(const std::vector<Quad>& positions) {
  grains_.resize(static_cast<int>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    grains_.position[i] = positions[i];
    grains_.position[i].w = 0.0;
  }
  rebuild();
  reset_accounts();
}

int GrainSolver::index_of(int id) const {
  return static_cast<int>(std::find(grains_.id.begin(), grains_.id.end(), id) - grains_.id.begin());
}

void GrainSolver::reset_accounts() {
  const Accounts old = accounts_;
  accounts_ = {};
  accounts_.elastic = accounts_.elastic_start = old.elastic;
  accounts_.floor_force = old.floor_force;
  accounts_.contacts = old.contacts;
  accounts_.contact_force = old.contact_force;
  accounts_.net_force = old.net_force;
  for (int g = 0; g < grains_.count; ++g) {
    const Quad &v = grains_.velocity[g], &w = grains_.spin[g];
    accounts_.kinetic += 0.5 * params_.grain.mass * (v.x * v.x + v.y * v.y + v.z * v.z) +
                         0.5 * params_.grain.inertia * (w.x * w.x + w.y * w.y + w.z * w.z);
    accounts_.height += grains_.position[g].z;
    accounts_.velocity += Vec3(v.x, v.y, v.z);
  }
  pairs_.set_rebuilds(0);
}

void GrainSolver::rebuild() {
  std::vector<std::int32_t> order;
  pairs_.rebuild(grains_, params_.threads, order);
  surfaces_.reorder(order);
  surfaces_.resize(static_cast<int>(pairs_.blocks().size()));
}

// The touching pairs of a block, four at a time. With d = x_i − x_j the arms r − δ/2 are ±d/2, so
//   v = v_i − v_j − ½ (ω_i + ω_j) × d,   torque on i and on j: −½ d × F_t.
template <class Law, bool kRolling>
static void pair_forces(Grains& grains, PairBlock& block, const ContactCoefficients& c, double diameter,
                        double dt, const std::int32_t* list, int count, bool inner, bool measure,
                        LaneSums& sums) {
  const Quad *x = grains.position.data(), *v = grains.velocity.data(), *w = grains.spin.data();
  const Lane zero{};
  for (int at = 0; at < count; at += kLanes) {
    const int valid = std::min(kLanes, count - at);
    std::int32_t p[kLanes], i[kLanes], j[kLanes];
    for (int k = 0; k < kLanes; ++k) {
      p[k] = list[at + std::min(k, valid - 1)];
      i[k] = block.i[p[k]];
      j[k] = block.j[p[k]];
    }
    const Triple<Lane> d = transpose(load(x[i[0]]) - load(x[j[0]]), load(x[i[1]]) - load(x[j[1]]),
                                     load(x[i[2]]) - load(x[j[2]]), load(x[i[3]]) - load(x[j[3]]));
    const Triple<Lane> dv = transpose(load(v[i[0]]) - load(v[j[0]]), load(v[i[1]]) - load(v[j[1]]),
                                      load(v[i[2]]) - load(v[j[2]]), load(v[i[3]]) - load(v[j[3]]));
    const Triple<Lane> turn = transpose(load(w[i[0]]) + load(w[j[0]]), load(w[i[1]]) + load(w[j[1]]),
                                        load(w[i[2]]) + load(w[j[2]]), load(w[i[3]]) + load(w[j[3]]));
    ContactMotion<Lane> motion;
    const Lane distance = root(dot(d, d));
    motion.normal = (1.0 / distance) * d;
    motion.overlap = diameter - distance;
    motion.velocity = dv - splat(0.5) * cross(turn, d);
    motion.spin = 0.5 * dot(turn, motion.normal);
    if constexpr (kRolling)
      motion.roll = transpose(load(w[i[0]]) - load(w[j[0]]), load(w[i[1]]) - load(w[j[1]]),
                              load(w[i[2]]) - load(w[j[2]]), load(w[i[3]]) - load(w[j[3]]));

    ContactHistory<Lane> history;
    if constexpr (Law::kHistory) {
      const Quad* h = block.tangential.data();
      history.tangential =
          transpose(load(h[p[0]]), load(h[p[1]]), load(h[p[2]]), load(h[p[3]]), history.root_overlap);
      if constexpr (kRolling) {
        const Quad* q = block.rolling.data();
        history.rolling = transpose(load(q[p[0]]), load(q[p[1]]), load(q[p[2]]), load(q[p[3]]));
      }
    }
    const ContactForce<Lane> f = Law::template force<kRolling>(c, dt, motion, history);

    Lane row[kLanes];
    if constexpr (Law::kHistory) {
      transpose_back(history.tangential, history.root_overlap, row);
      for (int k = 0; k < kLanes; ++k) store(block.tangential[p[k]], row[k]);
      if constexpr (kRolling) {
        transpose_back(history.rolling, zero, row);
        for (int k = 0; k < kLanes; ++k) store(block.rolling[p[k]], row[k]);
      }
    }
    const Triple<Lane> force = f.normal * motion.normal + f.tangential;
    const Triple<Lane> torque = splat(-0.5) * cross(d, f.tangential);
    Lane force_row[kLanes], torque_row[kLanes], rolling_row[kLanes] = {};
    transpose_back(force, zero, force_row);
    transpose_back(torque, zero, torque_row);
    if constexpr (kRolling) transpose_back(f.rolling, zero, rolling_row);
    for (int k = 0; k < valid; ++k) {
      add(grains.force[i[k]], force_row[k]);
      add(grains.torque[i[k]], torque_row[k] + rolling_row[k]);
      if (inner) {
        add(grains.force[j[k]], -force_row[k]);
        add(grains.torque[j[k]], torque_row[k] - rolling_row[k]);
      } else {
        const int slot = p[k] - block.inner;
        store(block.slot_force[slot], force_row[k]);
        store(block.slot_torque[slot], torque_row[k] - rolling_row[k]);
      }
    }
    Lane power = power_of(f, motion);
    if constexpr (kRolling) power += dot(f.rolling, motion.roll);
    const LaneMask real = LaneMask{0, 1, 2, 3} < LaneMask{valid, valid, valid, valid};
    sums.power += select(real, power, zero);
    sums.elastic += select(real, f.energy, zero);
    sums.overlap = larger(sums.overlap, motion.overlap);
    if (measure) sums.force += select(real, root(dot(force, force)), zero);
  }
}

/// Grains against the bin: arm r − δ, the wall at rest.
template <class Law, bool kRolling>
static void wall_forces(Grains& grains, PairBlock& block, const SolverParams& params,
                        const SolverCoefficients& all, double dt, bool measure) {
  for (WallContact& contact : block.walls) {
    const int g = contact.grain;
    const double distance = params.bin.distance(contact.wall, grains.position[g]);
    ContactMotion<double> motion;
    motion.overlap = params.grain.radius - distance;
    if (!(motion.overlap > 0.0)) {
      contact.tangential = contact.rolling = {};
      continue;
    }
    const Quad &v = grains.velocity[g], &w = grains.spin[g];
    motion.normal = Bin::normal(contact.wall);
    motion.roll = {w.x, w.y, w.z};
    const Triple<double> arm = -distance * motion.normal;
    motion.velocity = Triple<double>{v.x, v.y, v.z} + cross(motion.roll, arm);
    motion.spin = 0.5 * dot(motion.roll, motion.normal);
    Quad &t = contact.tangential, &r = contact.rolling;
    ContactHistory<double> history{{t.x, t.y, t.z}, t.w, {r.x, r.y, r.z}};
    const ContactForce<double> f =
        Law::template force<kRolling>(contact.wall == kFloor ? all.floor : all.side, dt, motion, history);
    if constexpr (Law::kHistory) {
      t = {history.tangential.x, history.tangential.y, history.tangential.z, history.root_overlap};
      if constexpr (kRolling) r = {history.rolling.x, history.rolling.y, history.rolling.z, 0.0};
    }
    const Triple<double> force = f.normal * motion.normal + f.tangential;
    const Triple<double> torque = cross(arm, f.tangential) + f.rolling;
    const Lane force_lane{force.x, force.y, force.z, 0.0};
    add(grains.force[g], force_lane);
    add(grains.torque[g], Lane{torque.x, torque.y, torque.z, 0.0});

    BlockSums& sums = block.sums;
    sums.power += power_of(f, motion) + dot(f.rolling, motion.roll);
    sums.elastic += f.energy;
    sums.max_overlap = std::max(sums.max_overlap, motion.overlap);
    add(sums.wall_force, force_lane);
    if (contact.wall == kFloor) sums.floor_force += force.z;
    if (measure) sums.contact_force += std::sqrt(dot(force, force));
    ++sums.contacts;
  }
}

template <class Law, bool kRolling>
void GrainSolver::contacts_of_block(int b, double dt, bool measure) {
  PairBlock& block = pairs_.blocks()[b];
  block.sums = {};
  for (int g = block.first; g < block.last; ++g) grains_.force[g] = grains_.torque[g] = {};
  std::int32_t* list = touching_[omp_get_thread_num()].data();
  const double diameter = 2.0 * params_.grain.radius;
  LaneSums sums;
  int count = filter(block, grains_, 0, block.inner, diameter, list);
  pair_forces<Law, kRolling>(grains_, block, coefficients_.pair, diameter, dt, list, count, true, measure,
                             sums);
  block.sums.contacts = count;
  count = filter(block, grains_, block.inner, block.pairs, diameter, list);
  pair_forces<Law, kRolling>(grains_, block, coefficients_.pair, diameter, dt, list, count, false, measure,
                             sums);
  block.sums.contacts += count;
  sums.add_to(block.sums);
  wall_forces<Law, kRolling>(grains_, block, params_, coefficients_, dt, measure);
  if (surfaces_.any()) surfaces_.evaluate<Law>(grains_, block, b, dt);
}

template <class Law, bool kRolling>
void GrainSolver::evaluate(double dt, bool measure) {
  const int count = static_cast<int>(pairs_.blocks().size());
#pragma omp parallel for num_threads(params_.threads) schedule(dynamic, 1)
  for (int b = 0; b < count; ++b) contacts_of_block<Law, kRolling>(b, dt, measure);
}

void GrainSolver::integrate_block(PairBlock& block, double dt, bool measure) {
  for (const Incoming& in : block.incoming) {
    const PairBlock& from = pairs_.blocks()[in.block];
    add(grains_.force[in.grain], -load(from.slot_force[in.slot]));
    add(grains_.torque[in.grain], load(from.slot_torque[in.slot]));
  }
  const double mass = params_.grain.mass, inertia = params_.grain.inertia;
  const double keep = 1.0 / (1.0 + dt * drag_);
  const Lane gravity{0.0, 0.0, -params_.gravity, 0.0};
  const double length = params_.bin.length, half_width = 0.5 * params_.bin.width;
  Lane kinetic{}, work{}, momentum{}, height{};
  double travel2 = 0.0, net = 0.0;
  for (int g = block.first; g < block.last; ++g) {
    const Lane f = load(grains_.force[g]), t = load(grains_.torque[g]);
    const Lane a = f / mass + gravity, alpha = t / inertia;
    const Lane v = (load(grains_.velocity[g]) + dt * a) * keep;
    const Lane w = (load(grains_.spin[g]) + dt * alpha) * keep;
    const Lane x = load(grains_.position[g]) + dt * v;
    store(grains_.velocity[g], v);
    store(grains_.spin[g], w);
    store(grains_.position[g], x);
    const Lane d = x - load(grains_.listed_at[g]);
    const Lane d2 = d * d;
    travel2 = std::max(travel2, d2[0] + d2[1] + d2[2]);
    kinetic += (0.5 * mass) * v * v + (0.5 * inertia) * w * w;
    work += f * a + t * alpha;
    momentum += v;
    height += x;
    const bool inside =
        x[0] >= 0.0 && x[0] <= length && std::abs(x[1]) <= half_width && x[2] >= 0.0 && x[2] < 1e6;
    if (!inside && block.sums.lost < 0) block.sums.lost = g;
    if (measure) {
      const Lane n = f + mass * gravity, n2 = n * n;
      net += std::sqrt(n2[0] + n2[1] + n2[2]);
    }
  }
  block.sums.kinetic = sum_of(kinetic);
  block.sums.step_work = sum_of(work);
  store(block.sums.velocity, momentum);
  block.sums.height = height[2];
  block.sums.max_travel2 = travel2;
  block.sums.net_force = net;
}

void GrainSolver::reduce(double dt, bool measure) {
  Accounts& a = accounts_;
  double power = 0.0, work = 0.0, contact_force = 0.0, net_force = 0.0;
  Quad wall;
  a.elastic = a.floor_force = a.kinetic = a.height = 0.0;
  a.velocity.setZero();
  a.contacts = 0;
  for (const PairBlock& block : pairs_.blocks()) {
    const BlockSums& s = block.sums;
    power += s.power + s.surface_power;
    work += s.step_work;
    contact_force += s.contact_force;
    net_force += s.net_force;
    add(wall, load(s.wall_force));
    a.elastic += s.elastic;
    a.floor_force += s.floor_force;
    a.kinetic += s.kinetic;
    a.height += s.height;
    a.velocity += Vec3(s.velocity.x, s.velocity.y, s.velocity.z);
    a.contacts += s.contacts;
    a.max_overlap = std::max(a.max_overlap, s.max_overlap);
  }
  // Forces of the step act on velocities that change during it: Σ F·v at mid-step = Σ F·v + ½ dt Σ (F·a + T·α).
  a.contact_work += dt * (power + 0.5 * dt * work);
  a.wall_impulse += dt * Vec3(wall.x, wall.y, wall.z);
  if (measure) {
    a.contact_force = contact_force;
    a.net_force = net_force;
  }
}

int GrainSolver::step(double dt, bool measure) {
  touching_.resize(std::max<std::size_t>(touching_.size(), params_.threads));
  std::size_t most = kLanes;
  for (const PairBlock& block : pairs_.blocks()) most = std::max<std::size_t>(most, block.pairs + kLanes);
  for (auto& list : touching_)
    if (list.size() < most) list.resize(most);

  if (params_.law == LawKind::mindlin) {
    params_.rolling ? evaluate<MindlinLaw, true>(dt, measure) : evaluate<MindlinLaw, false>(dt, measure);
  } else {
    params_.rolling ? evaluate<CoulombLaw, true>(dt, measure) : evaluate<CoulombLaw, false>(dt, measure);
  }
  if (surfaces_.any()) accounts_.surface_impulse += surfaces_.hand_over(dt);

  std::vector<PairBlock>& blocks = pairs_.blocks();
  const int count = static_cast<int>(blocks.size());
#pragma omp parallel for num_threads(params_.threads) schedule(dynamic, 1)
  for (int b = 0; b < count; ++b) integrate_block(blocks[b], dt, measure);
  reduce(dt, measure);

  double travel2 = 0.0;
  for (const PairBlock& block : blocks) {
    if (block.sums.lost >= 0) return block.sums.lost;
    travel2 = std::max(travel2, block.sums.max_travel2);
  }
  if (travel2 > 0.25 * params_.skin * params_.skin) rebuild();
  return -1;
}

}  // namespace furrow::dem
