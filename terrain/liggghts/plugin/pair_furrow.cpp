#include "terrain/liggghts/plugin/pair_furrow.hpp"

#include <algorithm>
#include <cmath>

#include <neigh_list.h>

#include "terrain/dem/size_scale.hpp"

namespace furrow::terrain::liggghts {
namespace {

using namespace simd;
using dem::ContactForce;
using dem::ContactHistory;
using dem::ContactMotion;

Triple<double> triple(const double* v) { return {v[0], v[1], v[2]}; }
void add(double* to, const Triple<double>& v) { to[0] += v.x, to[1] += v.y, to[2] += v.z; }
void put(double* to, const Triple<double>& v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

}  // namespace

void PairFurrow::set_up(const EngineSetup& setup) {
  law_ = setup.law;
  rolling_ = setup.rolling;
  sizes_ = setup.sizes;
  radius_ = setup.grain.radius;
}

/// "1": the value turns its sign where the pair is seen from the other grain.
void PairFurrow::settings(int, char**) {
  for (const char* name : {"tangential_x", "tangential_y", "tangential_z"}) add_history_value(name, "1");
  add_history_value("root_overlap", "0");
  for (const char* name : {"rolling_x", "rolling_y", "rolling_z"}) add_history_value(name, "1");
}

void PairFurrow::remember(std::span<const PairRecord> records) {
  for (const PairRecord& r : records) remembered_.emplace(pair_key(r.i, r.j), r);
}

void PairFurrow::recall() {
  if (remembered_.empty()) return;
  const int* const id = atom->tag;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    const int* const neighbours = list->firstneigh[i];
    int* const touch = listgranhistory->firstneigh[i];
    double* const histories = listgranhistory->firstdouble[i];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = neighbours[jj] & NEIGHMASK;
      const bool turned = id[i] > id[j];
      const auto found =
          remembered_.find(turned ? pair_key(id[j] - 1, id[i] - 1) : pair_key(id[i] - 1, id[j] - 1));
      if (found == remembered_.end()) continue;
      const PairRecord& r = found->second;
      double* const h = histories + jj * dnum();
      for (int k = 0; k < 3; ++k) {
        h[kTangential + k] = turned ? -r.tangential[k] : r.tangential[k];
        h[kRolling + k] = turned ? -r.rolling[k] : r.rolling[k];
      }
      h[kRoot] = r.root_overlap;
      touch[jj] = 1;
    }
  }
  remembered_ = {};
}

std::vector<PairRecord> PairFurrow::records() {
  std::vector<PairRecord> all;
  const int* const id = atom->tag;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    const int* const touch = listgranhistory->firstneigh[i];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      if (!touch[jj]) continue;
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      const double* const h = listgranhistory->firstdouble[i] + jj * dnum();
      const bool turned = id[i] > id[j];
      const double sign = turned ? -1.0 : 1.0;
      PairRecord r;
      r.i = (turned ? id[j] : id[i]) - 1, r.j = (turned ? id[i] : id[j]) - 1;
      for (int k = 0; k < 3; ++k) {
        r.tangential[k] = sign * h[kTangential + k];
        r.rolling[k] = sign * h[kRolling + k];
      }
      r.root_overlap = h[kRoot];
      all.push_back(r);
    }
  }
  return all;
}

void PairFurrow::compute_force(int, int, int) {
  if (!shearupdate()) return recall();  // the set-up of a run: no step
  sums_ = {};
  if (law_ == dem::LawKind::hertz_tanh) {
    rolling_ ? evaluate<dem::HertzTanhLaw, true, false>() : evaluate<dem::HertzTanhLaw, false, false>();
  } else if (sizes_) {
    rolling_ ? evaluate<dem::MindlinLaw, true, true>() : evaluate<dem::MindlinLaw, false, true>();
  } else {
    rolling_ ? evaluate<dem::MindlinLaw, true, false>() : evaluate<dem::MindlinLaw, false, false>();
  }
}

double PairFurrow::held(const double* h, double r_i, double r_j) const {
  const auto c =
      sizes_ ? dem::scaled(coefficients_, dem::pair_scale(r_i / radius_, r_j / radius_)) : coefficients_;
  return dem::held_by_springs(c, triple(h + kTangential), h[kRoot], triple(h + kRolling));
}

/// Seen from the other grain every vector turns its sign and nothing else changes: on either side of a border the pair
/// has the same force to the last bit.
template <class Law, bool kRoll, bool kSizes>
void PairFurrow::evaluate() {
  const double* const radius = atom->radius;
  const int owned = atom->nlocal, values = dnum();
  const double dt = since_;
  double** const x = atom->x;
  double** const v = atom->v;
  double** const w = atom->omega;
  double** const f = atom->f;
  double** const t = atom->torque;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    const int* const neighbours = list->firstneigh[i];
    int* const touch = listgranhistory->firstneigh[i];
    double* const histories = listgranhistory->firstdouble[i];
    const Triple<double> x_i = triple(x[i]), v_i = triple(v[i]), w_i = triple(w[i]);
    const double r_i = radius[i];
    Triple<double> force{0, 0, 0}, torque{0, 0, 0};
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = neighbours[jj] & NEIGHMASK;
      const Triple<double> d = x_i - triple(x[j]);
      const double sum = r_i + radius[j], gap = sum * sum - dot(d, d);
      double* const h = histories + jj * values;
      if (!(gap > 0.0)) {
        if (touch[jj]) {
          if (losses_) sums_.sample.power.opening += (j < owned ? 1.0 : 0.5) * held(h, r_i, radius[j]) / dt;
          touch[jj] = 0;
          std::fill_n(h, values, 0.0);
        }
        continue;
      }
      const double share = j < owned ? 1.0 : 0.5;
      const double distance = std::sqrt(dot(d, d)), delta = r_i - radius[j];
      const Triple<double> w_j = triple(w[j]), turn = w_i + w_j;
      ContactMotion<double> m;
      m.normal = (1.0 / distance) * d;
      m.overlap = gap / (sum + distance);
      m.root_overlap = std::sqrt(m.overlap);
      m.roll = w_i - w_j;
      m.velocity = v_i - triple(v[j]) - 0.5 * cross(turn, d);
      if constexpr (kSizes) m.velocity = m.velocity - (0.5 * delta) * cross(m.roll, m.normal);
      m.spin = 0.5 * dot(turn, m.normal);
      dem::ContactCoefficients c = coefficients_;
      if constexpr (kSizes) c = dem::scaled(c, dem::pair_scale(r_i / radius_, radius[j] / radius_));
      ContactHistory<double> history{triple(h + kTangential), h[kRoot], triple(h + kRolling)};
      if (losses_) dem::add(sums_.sample, dem::sample_of<Law, kRoll>(c, dt, m, history), share);
      const ContactForce<double> at = Law::template force<kRoll>(c, dt, m, history);
      touch[jj] = 1;
      if constexpr (Law::kHistory) {
        put(h + kTangential, history.tangential);
        h[kRoot] = history.root_overlap;
        if constexpr (kRoll) put(h + kRolling, history.rolling);
      }
      const Triple<double> push = at.normal * m.normal + at.tangential;
      const Triple<double> arm = -0.5 * cross(d, at.tangential);
      Triple<double> couple = at.rolling;
      if constexpr (kSizes) couple = couple - (0.5 * delta) * cross(m.normal, at.tangential);
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
  }
}

}  // namespace furrow::terrain::liggghts
