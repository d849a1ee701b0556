#include "terrain/liggghts/plugin/pair_furrow.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "terrain/dem/accounts/sample_lanes.hpp"
#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/dem/contact/laws.hpp"

namespace furrow::terrain::liggghts {
namespace {

using namespace simd;
using dem::ContactForce;
using dem::ContactHistory;
using dem::ContactMotion;

constexpr int kAhead = 8;  // pairs ahead whose grains are prefetched; waiting for memory took a quarter

constexpr int kTogether = 512;  // rows whose grains and pairs take about a quarter of a core's second cache

Triple<double> triple(const double* v) { return {v[0], v[1], v[2]}; }
Triple<double> triple(const dem::Quad& q) { return {q.x, q.y, q.z}; }
void add(double* to, const Triple<double>& v) { to[0] += v.x, to[1] += v.y, to[2] += v.z; }
std::array<double, 3> array(const dem::Quad& q) { return {q.x, q.y, q.z}; }

}  // namespace

void PairFurrow::set_up(const EngineSetup& setup) {
  law_ = setup.law;
  rolling_ = setup.rolling;
  sizes_ = setup.sizes;
  radius_ = setup.grain.radius;
  lists_.set_up({setup.skin, setup.largest, setup.bin.width, setup.rolling});
}

std::vector<PairRecord> PairFurrow::records() {
  std::vector<PairRecord> all;
  const int* const id = atom->tag;
  lists_.for_touching([&](int i, int j, int entry) {
    const bool turned = id[i] > id[j];
    const PairHistory h = turned ? lists_.history(entry).turned() : lists_.history(entry);
    all.push_back({(turned ? id[j] : id[i]) - 1, (turned ? id[i] : id[j]) - 1, array(h.tangential), h.tangential.w,
                   array(h.rolling)});
  });
  return all;
}

void PairFurrow::compute_force(int, int, int) {
  if (!shearupdate()) return;  // set-up of a run, not a step
  sums_ = {};
  dem::with_law(law_, rolling_, sizes_,
                [&](auto law, auto rolling, auto sizes) { evaluate<decltype(law), rolling, sizes>(); });
}

/// Seen from the other grain, every vector changes its sign and nothing else changes. So on either side of a border the
/// pair has the same force to the last bit.
template <class Law, bool kRoll, bool kSizes>
void PairFurrow::evaluate() {
  const double* const radius = atom->radius;
  const int owned = atom->nlocal;
  const double dt = since_;
  double** const x = atom->x;
  double** const v = atom->v;
  double** const w = atom->omega;
  double** const f = atom->f;
  double** const t = atom->torque;
  FURROW_ASSERT(work_ != nullptr && grains_.count == lists_.rows(), grains_.count, lists_.rows());
  const std::int32_t* const partner = lists_.partner();
  std::uint8_t* const touching = lists_.touching();
  dem::Quad* const tangential = lists_.tangential();
  dem::Quad* const rolling = lists_.rolling();
  const auto reference = coefficients_.of<Law>();
  dem::SampleLanes<Law, kRoll> samples(reference, dt, sums_.sample);
  int asked = 0;  // rows whose grains were passed to work_
  const int rows = lists_.rows(), last = rows > 0 ? lists_.end(rows - 1) : 0;
  for (int row = 0; row < rows; ++row) {
    const int i = lists_.grain(row), end = lists_.end(row);
    const Triple<double> x_i = triple(x[i]), v_i = triple(v[i]), w_i = triple(w[i]);
    const double r_i = radius[i];
    Triple<double> force{0, 0, 0}, torque{0, 0, 0};
    const auto coefficients = [&](int j) {
      return kSizes ? dem::sized_pair<Law>(reference, radius_, r_i, radius[j]) : reference;
    };
    for (int e = lists_.begin(row); e < end; ++e) {
      const int j = partner[e];
      if (e + kAhead < last) {
        const int next = partner[e + kAhead];
        __builtin_prefetch(x[next]);
        __builtin_prefetch(v[next]);
        __builtin_prefetch(w[next]);
        __builtin_prefetch(f[next], 1);
        __builtin_prefetch(t[next], 1);
      }
      const Triple<double> d = x_i - triple(x[j]);
      const double sum = r_i + radius[j], gap = sum * sum - dot(d, d);
      if (!(gap > 0.0)) {
        if (touching[e]) {
          if (losses_) {
            const PairHistory h = lists_.history(e);
            const ContactHistory<double> before{triple(h.tangential), h.tangential.w, triple(h.rolling)};
            const double held = Law::held(coefficients(j), 0.0, before).tangential;
            sums_.sample.power.opening += (j < owned ? 1.0 : 0.5) * held / dt;
          }
          touching[e] = 0;
          tangential[e] = {};
          if constexpr (kRoll) rolling[e] = {};
        }
        continue;
      }
      const double share = j < owned ? 1.0 : 0.5;
      const double delta = r_i - radius[j];
      const Triple<double> w_j = triple(w[j]);
      ContactMotion<double> m;
      dem::set_pair_overlap(m, d, gap, sum);
      m.roll = w_i - w_j;
      dem::set_pair_velocity<kSizes>(m, d, {v_i - triple(v[j]), w_i + w_j, m.roll, delta});
      const auto c = coefficients(j);
      ContactHistory<double> history{triple(tangential[e]), tangential[e].w, {0, 0, 0}};
      if constexpr (kRoll) history.rolling = triple(rolling[e]);
      if (losses_) {
        if constexpr (kSizes)
          dem::add(sums_.sample, dem::sample_of<Law, kRoll>(c, dt, m, history), share);
        else
          samples.add(m, history, share);
      }
      const ContactForce<double> at = Law::template force<kRoll>(c, dt, m, history);
      touching[e] = 1;
      if constexpr (Law::kHistory) {
        const Triple<double>& s = history.tangential;
        tangential[e] = {s.x, s.y, s.z, history.root_overlap};
        if constexpr (kRoll) rolling[e] = {history.rolling.x, history.rolling.y, history.rolling.z, 0.0};
      }
      const auto [push, arm, couple] = dem::pair_loads<kSizes>(at, m.normal, d, delta);
      force = force + push;
      torque = torque + (arm + couple);
      if (j < owned) {
        add(f[j], -1.0 * push);
        add(t[j], arm - couple);
      }
      sums_.elastic += share * at.energy;
      sums_.contacts += share;
      if (m.overlap > sums_.max_overlap) sums_.max_overlap = m.overlap;
      const double part = m.overlap / (2.0 * std::min(r_i, radius[j]));
      if (part > sums_.max_share) {
        sums_.max_share = part;
        sums_.hardest_at = {x_i.x, x_i.y, x_i.z};
      }
    }
    add(f[i], force);
    add(t[i], torque);
    if (row + 1 == rows || row + 1 == asked + kTogether) {
      work_->add_forces(grains_, asked, row + 1, losses_);
      asked = row + 1;
    }
  }
  samples.finish();
}

}  // namespace furrow::terrain::liggghts
