// Computes SoilParameters of soil_tests.hpp from the results of all tests.
#include <algorithm>
#include <span>
#include <vector>

#include "terrain/soil/soil_tests.hpp"

namespace furrow::terrain::soil {
namespace {

/// The part of a curve that is used for fits.
PlateCurve from_sinkage(const PlateCurve& curve, double least) {
  PlateCurve part;
  part.width = curve.width;
  for (std::size_t k = 0; k < curve.sinkage.size(); ++k) {
    if (curve.sinkage[k] < least) continue;
    part.sinkage.push_back(curve.sinkage[k]);
    part.pressure.push_back(curve.pressure[k]);
  }
  return part;
}

VolumeShares shares_of(const std::vector<VolumeAccount>& accounts) {
  if (accounts.empty()) return {};
  const auto mean = [&](const auto& value) {
    std::vector<double> shares;
    for (const VolumeAccount& a : accounts) shares.push_back(value(a) / a.displaced);
    return mean_of(shares);
  };
  return {mean([](const VolumeAccount& a) { return a.heaved; }),
          mean([](const VolumeAccount& a) { return a.compacted; }),
          mean([](const VolumeAccount& a) { return a.residual(); })};
}

/// Means over the seeds; k and n are those of one fit to all curves, as they depend on each other.
PlateParameters parameters_of_plate(std::span<const Tested<PlateResult>> tests, std::size_t each, double from) {
  PlateParameters p;
  std::vector<double> k, n;
  std::vector<VolumeAccount> loaded, unloaded;
  std::vector<PlateCurve> all;
  for (std::size_t at = 0; at < tests.size(); at += each) {
    const PlateResult& r = tests[at].result;
    all.push_back(from_sinkage(r.curve, from));
    const PowerFit fit = fit_power({&all.back(), 1});
    k.push_back(fit.k), n.push_back(fit.n);
    loaded.push_back(r.volume);
    if (r.unloaded.displaced > 0.0) unloaded.push_back(r.unloaded);
  }
  const PowerFit fit = fit_power(all);
  p.k = mean_of(k), p.n = mean_of(n);
  p.k.value = fit.k, p.n.value = fit.n;
  p.loaded = shares_of(loaded), p.unloaded = shares_of(unloaded);
  return p;
}

BedParameters parameters_of_bed(std::span<const Tested<PlateResult>> tests, std::size_t each, double from) {
  BedParameters p;
  std::vector<PlateCurve> all;
  for (const auto& tested : tests) all.push_back(from_sinkage(tested.result.curve, from));
  const auto other = [&](const PlateCurve& curve) { return curve.width != all.front().width; };
  if (std::none_of(all.begin(), all.end(), other)) return p;
  std::vector<double> k_c, k_phi, n;
  for (std::size_t at = 0; at + each <= all.size(); at += each) {
    const BekkerFit fit = fit_bekker(std::span(all).subspan(at, each));
    k_c.push_back(fit.k_c), k_phi.push_back(fit.k_phi), n.push_back(fit.n);
  }
  const BekkerFit fit = fit_bekker(all);
  p.k_c = mean_of(k_c), p.k_phi = mean_of(k_phi), p.n = mean_of(n);
  // Values are from one fit to all curves, since k and n depend on each other; errors are those between seeds.
  p.k_c.value = fit.k_c, p.k_phi.value = fit.k_phi, p.n.value = fit.n;
  p.goodness = fit.goodness;
  return p;
}

void plate_parameters(const SoilResults& results, const SoilPlan& plan, double radius, SoilParameters& p) {
  const double from = plan.plate_from * radius;
  for (std::size_t bed = 0; bed < results.plate.size(); ++bed) {
    const std::span<const Tested<PlateResult>> tests = results.plate[bed];
    const std::size_t each = plan.plate_beds[bed].plates.size();
    if (tests.empty()) return;
    for (std::size_t k = 0; k < each; ++k) {
      p.plates.push_back(parameters_of_plate(tests.subspan(k), each, from));
      p.plates.back().bed = bed, p.plates.back().plate = k;
    }
    p.beds.push_back(parameters_of_bed(tests, each, from));
  }
  if (p.beds.empty()) return;
  const BedParameters& bed = p.beds[plan.deepest()];
  p.k_c = bed.k_c, p.k_phi = bed.k_phi, p.n = bed.n, p.bekker_goodness = bed.goodness;
}

void cone_parameters(const SoilResults& results, const SoilPlan& plan, SoilParameters& p) {
  const std::size_t each = plan.cones.size();
  for (std::size_t k = 0; k < each && k < results.cone.size(); ++k) {
    std::vector<double> index, mean, gradient;
    for (std::size_t at = k; at < results.cone.size(); at += each) {
      const ConeResult& r = results.cone[at].result;
      index.push_back(r.index), mean.push_back(r.mean), gradient.push_back(r.gradient);
    }
    p.cones.push_back({mean_of(index), mean_of(mean), mean_of(gradient)});
  }
  if (!p.cones.empty()) p.cone_index = p.cones.front().index;
}

void shear_parameters(const SoilResults& results, SoilParameters& p) {
  if (results.shear.empty()) return;
  std::vector<double> normal, most, final, K;
  for (const auto& tested : results.shear) {
    const ShearResult& r = tested.result;
    normal.push_back(r.normal_mean);
    most.push_back(r.janosi.tau_max);
    final.push_back(r.final_shear);
    K.push_back(r.janosi.K);
  }
  const CoulombFit fit = fit_coulomb(normal, most), late = fit_coulomb(normal, final);
  p.cohesion = fit.cohesion, p.phi = fit.phi, p.coulomb_goodness = fit.goodness;
  p.final_cohesion = late.cohesion, p.final_phi = late.phi;
  p.phi_alone = fit_friction(normal, most);
  p.K = mean_of(K);
}

void face_parameters(const SoilResults& results, SoilParameters& p) {
  for (const Face face : {Face::flat, Face::glued}) {
    std::vector<double> normal, final, K, roll, sliding;
    for (const auto& [specimen, r] : results.faces) {
      if (r.face != face) continue;
      normal.push_back(r.normal_mean), final.push_back(r.final_shear), K.push_back(r.janosi.K);
      roll.push_back(r.roll), sliding.push_back(r.sliding);
    }
    if (normal.empty()) continue;
    const CoulombFit fit = fit_coulomb(normal, final);
    p.interfaces.push_back({.face = face,
                            .delta = fit.phi,
                            .adhesion = fit.cohesion,
                            .delta_alone = fit_friction(normal, final),
                            .K = mean_of(K),
                            .roll = mean_of(roll),
                            .sliding = mean_of(sliding)});
  }
}

}  // namespace

SoilParameters soil_parameters(const SoilResults& results, const SoilPlan& plan, double radius) {
  SoilParameters p;
  plate_parameters(results, plan, radius, p);
  shear_parameters(results, p);
  face_parameters(results, p);
  const auto mean_over = [](const auto& tests, const auto& value) {
    std::vector<double> values;
    for (const auto& tested : tests) values.push_back(value(tested.result));
    return values.empty() ? Measured{} : mean_of(values);
  };
  cone_parameters(results, plan, p);
  p.repose = mean_over(results.repose, [](const ReposeResult& r) { return r.angle; });
  p.repose_dry = mean_over(results.dry, [](const ReposeResult& r) { return r.angle; });
  return p;
}

}  // namespace furrow::terrain::soil
