#include "tire/planar/planar_elements.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

double determinant(const std::array<double, 4>& f) { return f[0] * f[3] - f[1] * f[2]; }

/// The volumetric part of W.
double volume_energy(double kappa, double j) { return 0.5 * kappa * (j * j - 1.0 - 2.0 * std::log(j)); }

}  // namespace

PlanarElements::PlanarElements(const PlanarMesh& mesh, std::span<const PlanarMaterial> materials,
                               const PlanarOptions& options)
    : options_(options), mass_(mesh.position.size(), 0.0) {
  FURROW_ASSERT(options.width > 0.0, options.width);
  std::vector<std::vector<int>> entries(mesh.position.size());
  for (int e = 0; e < mesh.elements(); ++e) {
    const auto& t = mesh.triangles[e];
    FURROW_ASSERT(in_range(mesh.part[e], materials.size()), e, mesh.part[e], materials.size());
    const PlanarMaterial& material = materials[mesh.part[e]];
    const PlanarField& p = mesh.position;
    const double ax = p.x[t[1]] - p.x[t[0]], az = p.z[t[1]] - p.z[t[0]];
    const double bx = p.x[t[2]] - p.x[t[0]], bz = p.z[t[2]] - p.z[t[0]];
    const double determinant = ax * bz - bx * az;
    FURROW_ASSERT(determinant > 0.0, e, determinant);
    const std::array<double, 4> inverse{bz / determinant, -bx / determinant, -az / determinant, ax / determinant};
    for (int k = 0; k < 4; ++k) inverse_[k].push_back(inverse[k]);
    const PlanarModuli moduli = planar_moduli(material, options.law);
    area_.push_back(0.5 * determinant);
    mu_.push_back(moduli.mu), kappa_.push_back(moduli.kappa);
    viscosity_.push_back(material.viscosity), density_.push_back(material.density);
    for (int k = 0; k < 3; ++k) {
      node_[k].push_back(t[k]);
      mass_[t[k]] += material.density * determinant * options.width / 6.0;
      entries[t[k]].push_back(mesh.elements() * k + e);
    }
  }
  push_x_.resize(3 * mu_.size()), push_z_.resize(3 * mu_.size());
  for (const auto& of_node : entries) {
    first_.push_back(static_cast<int>(entry_.size()));
    entry_.insert(entry_.end(), of_node.begin(), of_node.end());
  }
  first_.push_back(static_cast<int>(entry_.size()));
  if (options.averaged) make_patches(mesh);
}

void PlanarElements::make_patches(const PlanarMesh& mesh) {
  std::map<std::pair<int, int>, int> known;
  for (int e = 0; e < size(); ++e)
    for (int k = 0; k < 3; ++k) {
      const auto [at, added] =
          known.try_emplace({mesh.triangles[e][k], mesh.part[e]}, static_cast<int>(patches_.size()));
      if (added) patches_.emplace_back().kappa = kappa_[e];
      Patch& patch = patches_[at->second];
      patch.area += area_[e] / 3.0;
      patch.elements.push_back(e);
      patch_[k].push_back(at->second);
    }
  volume_.resize(mu_.size()), pressure_.resize(mu_.size()), patch_pressure_.resize(patches_.size());
}

void PlanarElements::average(const PlanarField& field) {
  const int n = size();
  const double *x = field.x.data(), *z = field.z.data();
  const int *n0 = node_[0].data(), *n1 = node_[1].data(), *n2 = node_[2].data();
  double* volume = volume_.data();
#pragma omp simd
  for (int e = 0; e < n; ++e)
    volume[e] = 0.5 * ((x[n1[e]] - x[n0[e]]) * (z[n2[e]] - z[n0[e]]) - (x[n2[e]] - x[n0[e]]) * (z[n1[e]] - z[n0[e]]));
  for (std::size_t k = 0; k < patches_.size(); ++k) {
    const Patch& patch = patches_[k];
    double sum = 0.0;
    for (const int e : patch.elements) sum += volume[e];
    const double j = sum / (3.0 * patch.area);
    patch_pressure_[k] = patch.kappa * (j - 1.0 / j);
  }
  const double* of = patch_pressure_.data();
  const int *p0 = patch_[0].data(), *p1 = patch_[1].data(), *p2 = patch_[2].data();
  double* pressure = pressure_.data();
#pragma omp simd
  for (int e = 0; e < n; ++e) pressure[e] = (of[p0[e]] + of[p1[e]] + of[p2[e]]) / 3.0;
}

template <bool averaged>
bool PlanarElements::stresses(const PlanarField& position, const PlanarField& velocity) {
  const int n = size();
  const double *x = position.x.data(), *z = position.z.data();
  const double *u = velocity.x.data(), *w = velocity.z.data();
  const int *n0 = node_[0].data(), *n1 = node_[1].data(), *n2 = node_[2].data();
  const double *i00 = inverse_[0].data(), *i01 = inverse_[1].data();
  const double *i10 = inverse_[2].data(), *i11 = inverse_[3].data();
  const double *mu = mu_.data(), *kappa = kappa_.data(), *xi = viscosity_.data(), *area = area_.data();
  const double* pressure = pressure_.data();
  double *push0x = push_x_.data(), *push1x = push0x + n, *push2x = push1x + n;
  double *push0z = push_z_.data(), *push1z = push0z + n, *push2z = push1z + n;
  const double half = 0.5 * options_.width;
  int inverted = 0;
#pragma omp simd reduction(+ : inverted)
  for (int e = 0; e < n; ++e) {
    const int p0 = n0[e], p1 = n1[e], p2 = n2[e];
    const double ax = x[p1] - x[p0], az = z[p1] - z[p0], bx = x[p2] - x[p0], bz = z[p2] - z[p0];
    const double f00 = ax * i00[e] + bx * i10[e], f01 = ax * i01[e] + bx * i11[e];
    const double f10 = az * i00[e] + bz * i10[e], f11 = az * i01[e] + bz * i11[e];
    const double j = f00 * f11 - f01 * f10, one_over_j = 1.0 / j;
    inverted += j > 0.0 ? 0 : 1;
    const double p = averaged ? pressure[e] : kappa[e] * (j - one_over_j);
    const double m = mu[e] * one_over_j;
    // L_D F_D⁻¹, |F_D| = 2 A J.
    const double cx = u[p1] - u[p0], cz = w[p1] - w[p0], dx = u[p2] - u[p0], dz = w[p2] - w[p0];
    const double v = xi[e] * 0.5 * one_over_j / area[e];
    const double txx = m * (f00 * f00 + f01 * f01 - 1.0) + p + v * (cx * bz - dx * az);
    const double tzz = m * (f10 * f10 + f11 * f11 - 1.0) + p + v * (dz * ax - cz * bx);
    const double txz = m * (f00 * f10 + f01 * f11) + 0.5 * v * (dx * ax - cx * bx + cz * bz - dz * az);
    // ½ T n b of the opposite sides: n = (−bz, bx) for node 1, (az, −ax) for node 2.
    const double p1x = half * (txz * bx - txx * bz), p1z = half * (tzz * bx - txz * bz);
    const double p2x = half * (txx * az - txz * ax), p2z = half * (txz * az - tzz * ax);
    push1x[e] = p1x, push1z[e] = p1z, push2x[e] = p2x, push2z[e] = p2z;
    push0x[e] = -(p1x + p2x), push0z[e] = -(p1z + p2z);
  }
  return inverted == 0;
}

void PlanarElements::gather(PlanarField& out) const {
  const double *of_x = push_x_.data(), *of_z = push_z_.data();
  const int n = nodes();
  for (int a = 0; a < n; ++a) {
    double sum_x = 0.0, sum_z = 0.0;
    for (int k = first_[a]; k < first_[a + 1]; ++k) sum_x += of_x[entry_[k]], sum_z += of_z[entry_[k]];
    out.x[a] = sum_x, out.z[a] = sum_z;
  }
}

bool PlanarElements::force(const PlanarField& x, const PlanarField& v, PlanarField& out) {
  FURROW_ASSERT(x.size() == mass_.size() && v.size() == x.size() && out.size() == x.size(), x.size(), v.size(),
                out.size());
  if (options_.averaged) average(x);
  const bool sound = options_.averaged ? stresses<true>(x, v) : stresses<false>(x, v);
  gather(out);
  return sound;
}

PlanarElements::Element PlanarElements::element(int e) const {
  return {{node_[0][e], node_[1][e], node_[2][e]},
          area_[e],
          mu_[e],
          kappa_[e],
          viscosity_[e],
          density_[e],
          {inverse_[0][e], inverse_[1][e], inverse_[2][e], inverse_[3][e]}};
}

std::array<double, 4> PlanarElements::gradient(const PlanarField& p, int e) const {
  const int a = node_[0][e], b = node_[1][e], c = node_[2][e];
  const double ax = p.x[b] - p.x[a], az = p.z[b] - p.z[a], bx = p.x[c] - p.x[a], bz = p.z[c] - p.z[a];
  return {ax * inverse_[0][e] + bx * inverse_[2][e], ax * inverse_[1][e] + bx * inverse_[3][e],
          az * inverse_[0][e] + bz * inverse_[2][e], az * inverse_[1][e] + bz * inverse_[3][e]};
}

std::vector<double> PlanarElements::volumetric(const PlanarField& x) const {
  std::vector<double> pressure(mu_.size(), 0.0);
  if (!options_.averaged) {
    for (int e = 0; e < size(); ++e) {
      const double j = determinant(gradient(x, e));
      pressure[e] = kappa_[e] * (j - 1.0 / j);
    }
    return pressure;
  }
  for (const Patch& patch : patches_) {
    double sum = 0.0;
    for (const int e : patch.elements) sum += area_[e] * determinant(gradient(x, e));
    const double j = sum / (3.0 * patch.area), p = patch.kappa * (j - 1.0 / j);
    for (const int e : patch.elements) pressure[e] += p / 3.0;
  }
  return pressure;
}

double PlanarElements::energy(const PlanarField& x) const {
  double sum = 0.0;
  for (int e = 0; e < size(); ++e) {
    const auto f = gradient(x, e);
    const double trace = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3], j = determinant(f);
    sum += area_[e] * 0.5 * mu_[e] * (trace - 2.0 - 2.0 * std::log(j));
    if (!options_.averaged) sum += area_[e] * volume_energy(kappa_[e], j);
  }
  for (const Patch& patch : patches_) {
    double volume = 0.0;
    for (const int e : patch.elements) volume += area_[e] * determinant(gradient(x, e));
    sum += patch.area * volume_energy(patch.kappa, volume / (3.0 * patch.area));
  }
  return sum * options_.width;
}

double PlanarElements::viscous_power(const PlanarField& x, const PlanarField& v) const {
  double sum = 0.0;
  for (int e = 0; e < size(); ++e) {
    const auto f = gradient(x, e), rate = gradient(v, e);  // L = Ḟ F⁻¹
    const double j = determinant(f);
    const double xx = (rate[0] * f[3] - rate[1] * f[2]) / j, zz = (rate[3] * f[0] - rate[2] * f[1]) / j;
    const double xz = 0.5 * (rate[1] * f[0] - rate[0] * f[1] + rate[2] * f[3] - rate[3] * f[2]) / j;
    sum += area_[e] * j * viscosity_[e] * (xx * xx + zz * zz + 2.0 * xz * xz);
  }
  return sum * options_.width;
}

PlanarStress PlanarElements::stress(const PlanarField& x, int e) const {
  const auto f = gradient(x, e);
  const double m = mu_[e] / determinant(f), p = volumetric(x)[e];
  return {m * (f[0] * f[0] + f[1] * f[1] - 1.0) + p, m * (f[0] * f[2] + f[1] * f[3]),
          m * (f[2] * f[2] + f[3] * f[3] - 1.0) + p};
}

}  // namespace furrow::tire
