#include "tire/ancf/shell_carcass.hpp"

#include "protocol/core/assert.hpp"
#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_matrices.hpp"

#include <cmath>

namespace furrow::tire {
namespace {

/// A branch over a step of h = x τ: H decays by the factor e^{−x} and responds to ΔE with the factor b; the mean of H
/// is b H + (1 − b)/x ΔE.
struct BranchStep {
  double decay, response, mean_response;
  BranchStep(const MaxwellBranch& branch, double h) {
    FURROW_ASSERT(branch.time > 0.0 && h > 0.0, branch.time, h);
    const double x = h / branch.time;
    decay = std::exp(-x);
    response = -std::expm1(-x) / x;
    mean_response = x < 1e-3 ? 0.5 - x / 6.0 + x * x / 24.0 : (1.0 - response) / x;
  }
};

}  // namespace

ShellCarcass::ShellCarcass(const TireFile& file, const ShellMesh& mesh)
    : layout_{mesh.columns, mesh.rows}, branches_(file.prony), pressure_(file.pressure) {
  const Mat3 next = mesh.turn(1);
  for (int j = 0; j < mesh.elements_width(); ++j) {
    const Vec3 corner[4] = {mesh.position[j], next * mesh.position[j], next * mesh.position[j + 1],
                            mesh.position[j + 1]};
    const Vec3 director[4] = {mesh.director[j], next * mesh.director[j], next * mesh.director[j + 1],
                              mesh.director[j + 1]};
    ElementNodes reference;
    for (int n = 0; n < 4; ++n) reference.row(2 * n) = corner[n], reference.row(2 * n + 1) = director[n];
    stiffness_.push_back(shell_stiffness(reference, shell_layers(file, file.section(j))));
    reference_.push_back(raw_strains(reference));
  }
}

std::size_t ShellCarcass::strains_size() const {
  return static_cast<std::size_t>(layout_.rows - 1) * layout_.batches() * kStrains * kDoubleLanes;
}

Double4 ShellCarcass::mask(int batch) const {
  Double4 m;
  for (int lane = 0; lane < kDoubleLanes; ++lane) m[lane] = batch * kDoubleLanes + lane < layout_.columns ? 1.0 : 0.0;
  return m;
}

void ShellCarcass::batch_strains_at(const Field& q, int j, int batch, Double4* e) const {
  FURROW_ASSERT(in_range(j, reference_.size()) && in_range(batch, layout_.batches()), j, reference_.size(), batch);
  BatchNodes nodes;
  nodes.read(layout_, q.data(), batch * kDoubleLanes, j);
  batch_strains(nodes, e);
  for (int k = 0; k < kStrains; ++k) e[k] -= reference_[j][k];
}

void ShellCarcass::strains(const Field& q, Field& e) const {
  e.resize(strains_size());
  Double4 now[kStrains];
  for (int j = 0; j + 1 < layout_.rows; ++j)
    for (int b = 0; b < layout_.batches(); ++b) {
      batch_strains_at(q, j, b, now);
      double* to = e.data() + (batch_of(e, j, b) - e.data());
      for (int k = 0; k < kStrains; ++k) store(to + k * kDoubleLanes, now[k]);
    }
}

void ShellCarcass::batch_stress_at(const Field& q_new, const Field& e_old, double c, int j, int batch,
                                   Double4* stress) const {
  Double4 e[kStrains];
  batch_strains_at(q_new, j, batch, e);
  const double* old = batch_of(e_old, j, batch);
  for (int k = 0; k < kStrains; ++k) {
    const Double4 before = load(old + k * kDoubleLanes);
    e[k] = before + c * (e[k] - before);
  }
  batch_stress(stiffness_[j].data(), e, stress);
}

void ShellCarcass::batch_stress_between(const BatchNodes& before, const BatchNodes& now, double c, int j,
                                        Double4* stress) const {
  Double4 old[kStrains], e[kStrains];
  batch_strains(before, old);
  batch_strains(now, e);
  for (int k = 0; k < kStrains; ++k) {
    old[k] -= reference_[j][k];
    e[k] = old[k] + c * (e[k] - reference_[j][k] - old[k]);
  }
  batch_stress(stiffness_[j].data(), e, stress);
}

void ShellCarcass::forces(const Field& q_new, const Field& q_force, const Field& e_old, double c, Field& f) const {
  FURROW_ASSERT(q_new.size() == layout_.size() && q_force.size() == layout_.size(), q_new.size(), q_force.size(),
                layout_.size());
  FURROW_ASSERT(e_old.size() == strains_size() && f.size() == layout_.size(), e_old.size(), f.size());
  std::fill(f.begin(), f.end(), 0.0);
  Double4 stress[kStrains];
  for (int j = 0; j + 1 < layout_.rows; ++j)
    for (int b = 0; b < layout_.batches(); ++b) {
      batch_stress_at(q_new, e_old, c, j, b, stress);
      const Double4 valid = mask(b);
      if (b + 1 == layout_.batches())
        for (Double4& s : stress) s *= valid;
      BatchNodes nodes;
      nodes.read(layout_, q_force.data(), b * kDoubleLanes, j);
      BatchForces(nodes, stress, pressure_ * valid).add(layout_, f.data(), b * kDoubleLanes, j);
    }
  layout_.fold_padding(f);
}

void ShellCarcass::begin(const Field& q, Step& step) const {
  FURROW_ASSERT(q.size() == layout_.size(), q.size(), layout_.size());
  strains(q, step.strains);
  step.new_strains = step.strains;
  step.stress.assign(strains_size(), 0.0);
  step.stress_change = step.stress;
  step.rows.assign(layout_.rows - 1, {});
  step.branch_strain.assign(branches_.size(), Field(strains_size(), 0.0));
  step.branch_stress = step.branch_strain;
  step.relaxed_stress.assign(branches_.empty() ? 0 : strains_size(), 0.0);
  Double4 e[kStrains], stress[kStrains];
  for (int j = 0; j + 1 < layout_.rows; ++j)
    for (int b = 0; b < layout_.batches(); ++b) {
      const std::size_t at = batch_of(step.strains, j, b) - step.strains.data();
      for (int k = 0; k < kStrains; ++k) e[k] = load(step.strains.data() + at + k * kDoubleLanes);
      batch_stress(stiffness_[j].data(), e, stress);
      for (int k = 0; k < kStrains; ++k) store(step.stress.data() + at + k * kDoubleLanes, mask(b) * stress[k]);
    }
}

double ShellCarcass::branch_gain(double h) const {
  double gain = 0.0;
  for (const MaxwellBranch& branch : branches_) gain += branch.modulus * BranchStep(branch, h).response;
  return gain;
}

void ShellCarcass::prepare(Step& step, double h) const {
  FURROW_ASSERT(h > 0.0, h);
  FURROW_ASSERT(step.stress.size() == strains_size(), step.stress.size(), strains_size());
  step.h = h;
  if (branches_.empty()) return;
  std::copy(step.stress.begin(), step.stress.end(), step.relaxed_stress.begin());
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const double decay = BranchStep(branches_[i], h).decay;
    for (std::size_t k = 0; k < step.stress.size(); ++k) step.relaxed_stress[k] += decay * step.branch_stress[i][k];
  }
}

void ShellCarcass::row_forces(const Field& q_new, const Field& q_force, Step& step, double c, int j, Field& f) const {
  Double4 e[kStrains], u[kStrains];
  Double4 elastic = {}, change = {};
  for (int b = 0; b < layout_.batches(); ++b) {
    const std::size_t at = batch_of(step.strains, j, b) - step.strains.data();
    const double *old = step.strains.data() + at, *stress = step.stress.data() + at,
                 *relaxed = branches_.empty() ? stress : step.relaxed_stress.data() + at;
    double *strains_to = step.new_strains.data() + at, *change_to = step.stress_change.data() + at;
    const Double4 valid = mask(b);
    batch_strains_at(q_new, j, b, e);
    for (int k = 0; k < kStrains; ++k) {
      store(strains_to + k * kDoubleLanes, e[k]);
      e[k] = valid * (e[k] - load(old + k * kDoubleLanes));
    }
    batch_stress(stiffness_[j].data(), e, u);
    for (int k = 0; k < kStrains; ++k) {
      const Double4 s = load(stress + k * kDoubleLanes);
      store(change_to + k * kDoubleLanes, u[k]);
      elastic += (s + 0.5 * u[k]) * e[k];
      change += u[k] * e[k];
      u[k] = load(relaxed + k * kDoubleLanes) + c * u[k];
    }
    BatchNodes nodes;
    nodes.read(layout_, q_force.data(), b * kDoubleLanes, j);
    BatchForces(nodes, u, pressure_ * valid).add(layout_, f.data(), b * kDoubleLanes, j);
  }
  step.rows[j].elastic = sum(elastic);
  step.rows[j].change = sum(change);
}

// Row j adds to the nodes of rows j and j + 1. Even rows come first, then odd rows, so that no two threads write to the
// same node.
void ShellCarcass::forces(const Field& q_new, const Field& q_force, Step& step, double c, Field& f, int threads) const {
  FURROW_ASSERT(step.h > 0.0 && threads > 0, step.h, threads);
  FURROW_ASSERT(q_new.size() == layout_.size() && q_force.size() == layout_.size(), q_new.size(), q_force.size(),
                layout_.size());
  FURROW_ASSERT(f.size() == layout_.size(), f.size(), layout_.size());
  const double with_branches = c + branch_gain(step.h);
  std::fill(f.begin(), f.end(), 0.0);
  for (const int parity : {0, 1}) {
    if (threads > 1) {
#pragma omp parallel for schedule(static) num_threads(threads)
      for (int j = parity; j < layout_.rows - 1; j += 2) row_forces(q_new, q_force, step, with_branches, j, f);
    } else {
      for (int j = parity; j < layout_.rows - 1; j += 2) row_forces(q_new, q_force, step, with_branches, j, f);
    }
  }
  layout_.fold_padding(f);
}

ShellCarcass::Energies ShellCarcass::accept(Step& step) const {
  FURROW_ASSERT(step.strains.size() == step.new_strains.size(), step.strains.size(), step.new_strains.size());
  FURROW_ASSERT(step.stress.size() == step.stress_change.size(), step.stress.size(), step.stress_change.size());
  Energies total;
  for (const Energies& row : step.rows) total.elastic += row.elastic, total.change += row.change;
  accept_branches(step, total);
  step.strains.swap(step.new_strains);
  for (std::size_t k = 0; k < step.stress.size(); ++k) step.stress[k] += step.stress_change[k];
  return total;
}

/// H_i and g_i D̂ H_i at the step's end. The loss is the work of the mean stress, Σ ΔEᵀ g D̂ H̄, minus the stored
/// energy: exact for a strain that changes at a constant rate.
void ShellCarcass::accept_branches(Step& step, Energies& total) const {
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const BranchStep branch(branches_[i], step.h);
    const double g = branches_[i].modulus;
    for (int j = 0; j + 1 < layout_.rows; ++j) {
      Double4 work = {}, change = {};
      for (int b = 0; b < layout_.batches(); ++b) {
        const std::size_t at = batch_of(step.strains, j, b) - step.strains.data();
        const Double4 valid = mask(b);
        for (int k = 0; k < kStrains; ++k) {
          const std::size_t n = at + static_cast<std::size_t>(k) * kDoubleLanes;
          double *strain = step.branch_strain[i].data() + n, *stress = step.branch_stress[i].data() + n;
          const Double4 e = valid * (load(step.new_strains.data() + n) - load(step.strains.data() + n)),
                        u = load(step.stress_change.data() + n), h = load(strain), s = load(stress);
          const Double4 h_new = branch.decay * h + branch.response * e,
                        s_new = branch.decay * s + g * branch.response * u;
          work += (branch.response * s + g * branch.mean_response * u) * e;
          change += s_new * h_new - s * h;
          store(strain, h_new);
          store(stress, s_new);
        }
      }
      const double stored = 0.5 * sum(change);
      total.stored += stored;
      total.relaxed += sum(work) - stored;
    }
  }
}

ShellCarcass::Energies ShellCarcass::account(const Field& q, Field& e) const {
  FURROW_ASSERT(e.size() == strains_size(), e.size(), strains_size());
  Double4 now[kStrains], delta[kStrains], s_now[kStrains], s_delta[kStrains];
  Energies total;
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    Double4 elastic = {}, change = {};
    for (int b = 0; b < layout_.batches(); ++b) {
      batch_strains_at(q, j, b, now);
      double* old = e.data() + (batch_of(e, j, b) - e.data());
      for (int k = 0; k < kStrains; ++k) {
        delta[k] = now[k] - load(old + k * kDoubleLanes);
        store(old + k * kDoubleLanes, now[k]);
      }
      batch_stress(stiffness_[j].data(), now, s_now);
      batch_stress(stiffness_[j].data(), delta, s_delta);
      const Double4 valid = mask(b);
      for (int k = 0; k < kStrains; ++k) {
        elastic += valid * now[k] * s_now[k];
        change += valid * delta[k] * s_delta[k];
      }
    }
    total.elastic += 0.5 * sum(elastic);
    total.change += sum(change);
  }
  return total;
}

double ShellCarcass::volume(const Field& q, const Vec3& centre) const {
  FURROW_ASSERT(q.size() == layout_.size(), q.size(), layout_.size());
  const Triple<Double4> c{spread(centre.x()), spread(centre.y()), spread(centre.z())};
  double total = 0.0;
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    Double4 row = {};
    for (int b = 0; b < layout_.batches(); ++b) {
      BatchNodes n;
      n.read(layout_, q.data(), b * kDoubleLanes, j);
      const BatchSlopes s(n);
      for (int k = 0; k < 2; ++k)
        for (int l = 0; l < 2; ++l) {
          const double left = l == 0 ? kNear : kFar, bottom = k == 0 ? kNear : kFar;
          const Triple<Double4> x = (left * bottom) * n.r[0] + ((1 - left) * bottom) * n.r[1] +
                                    ((1 - left) * (1 - bottom)) * n.r[2] + (left * (1 - bottom)) * n.r[3];
          row += mask(b) * dot(x - c, cross(s.a1[k], s.a2[l]));
        }
    }
    total += sum(row) / 3.0;
  }
  return total;
}

// Stokes: ∫ n dA = ½ ∮ x × dx and ∫ x × n dA = −½ ∮ |x|² dx around the boundary, here two polygons. With the
// surface on its left the left loop runs with the columns, the right loop against them.
Wrench ShellCarcass::pressure_resultant(const Field& q, const Vec3& centre) const {
  FURROW_ASSERT(q.size() == layout_.size(), q.size(), layout_.size());
  Wrench w;
  for (int side = 0; side < 2; ++side) {
    const int j = side == 0 ? 0 : layout_.rows - 1;
    const double sense = side == 0 ? pressure_ : -pressure_;
    for (int i = 0; i < layout_.columns; ++i) {
      const Vec3 a = layout_.get(q, i, j, 0) - centre, b = layout_.get(q, (i + 1) % layout_.columns, j, 0) - centre;
      w.force += 0.5 * sense * a.cross(b);
      w.moment -= sense / 6.0 * (a.squaredNorm() + a.dot(b) + b.squaredNorm()) * (b - a);
    }
  }
  return w;
}

}  // namespace furrow::tire
