#include "terrain/scm/pressure_sinkage.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::scm {
namespace {

constexpr double kLeastModulus = 0.05;  // of k_φ

}  // namespace

double PressureLaw::modulus(double b) const {
  FURROW_ASSERT(b > 0.0, b);
  return std::max(k_c / b + k_phi, kLeastModulus * k_phi);
}

PressureStep press(const PressureLaw& law, double modulus, double before, double now, double rate, SoilNode& node) {
  FURROW_ASSERT(modulus > 0.0, modulus);
  PressureStep step;
  const SoilNode old = node;
  const double p_before = old.elastic(before), e_before = std::max(before - old.plastic, 0.0);
  if (!(now > old.plastic)) return step;
  step.elastic = old.elastic(now);
  const bool virgin = !(old.stiffness > 0.0);
  if (!virgin && step.elastic <= old.yield) {
    step.pressure = std::clamp(step.elastic + law.damping * rate, 0.0, old.yield);
    return step;
  }
  const double p = std::max(old.yield, modulus * std::pow(now, law.n));
  if (!virgin && step.elastic <= p) {  // the curve has become stiffer, as b shrank
    node.yield = step.pressure = step.elastic;
    return step;
  }
  const double wong = law.unloading + law.unloading_rate * now;
  node.stiffness = std::max(wong, std::max(1.0, law.n) * p / now);
  node.plastic = std::max(now - p / node.stiffness, old.plastic);  // less by round-off alone
  node.yield = p;
  step.elastic = step.pressure = p;
  step.compaction = 0.5 * (p_before + p) * (node.plastic - old.plastic) -
                    0.5 * e_before * (now - node.plastic) * (node.stiffness - old.stiffness);
  return step;
}

}  // namespace furrow::terrain::scm
