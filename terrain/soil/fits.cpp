#include "terrain/soil/fits.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "protocol/core/assert.hpp"
#include "protocol/core/student_t.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kSearchPoints = 80;    // of the first, logarithmic search for K
constexpr int kGoldenSections = 60;  // after it

double mean(std::span<const double> values) {
  FURROW_ASSERT(!values.empty(), values.size());
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double square(double x) { return x * x; }

/// n and ln k_i of p = k_i zⁿ for all curves.
struct CommonExponent {
  double n = 0.0;
  std::vector<double> log_k;
};

bool usable(const PlateCurve& c, std::size_t k) { return c.sinkage[k] > 0.0 && c.pressure[k] > 0.0; }

CommonExponent fit_exponent(std::span<const PlateCurve> plates) {
  FURROW_ASSERT(std::all_of(plates.begin(), plates.end(),
                            [](const PlateCurve& c) {
                              return c.width > 0.0 && c.sinkage.size() == c.pressure.size() && c.sinkage.size() >= 2;
                            }),
                plates.size());
  // Normal equations of Σ_i Σ p² (ln p − ln k_i − n ln z)²: with the weighted means x̄_i of ln z and ȳ_i of ln p of
  // plate i,  n = Σ_i Σ p² (ln z − x̄_i)(ln p − ȳ_i) / Σ_i Σ p² (ln z − x̄_i)²,   ln k_i = ȳ_i − n x̄_i.
  struct Sums {
    double w = 0.0, x = 0.0, y = 0.0;
  };
  std::vector<Sums> sums(plates.size());
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < plates.size(); ++i) {
    const PlateCurve& c = plates[i];
    Sums& s = sums[i];
    for (std::size_t k = 0; k < c.sinkage.size(); ++k)
      if (usable(c, k)) {
        const double w = square(c.pressure[k]);
        s.w += w, s.x += w * std::log(c.sinkage[k]), s.y += w * std::log(c.pressure[k]);
      }
    s.x /= s.w, s.y /= s.w;
    for (std::size_t k = 0; k < c.sinkage.size(); ++k)
      if (usable(c, k)) {
        const double w = square(c.pressure[k]), dx = std::log(c.sinkage[k]) - s.x;
        xx += w * dx * dx, xy += w * dx * (std::log(c.pressure[k]) - s.y);
      }
  }
  CommonExponent fit;
  fit.n = xy / xx;
  for (const Sums& s : sums) fit.log_k.push_back(s.y - fit.n * s.x);
  return fit;
}

}  // namespace

double Measured::half_interval() const {
  return freedom > 0.0 && std::isfinite(standard_error) ? student_t(freedom) * standard_error : kUnknown;
}

Measured mean_of(std::span<const double> samples) {
  FURROW_ASSERT(!samples.empty(), samples.size());
  Measured m;
  m.samples = static_cast<int>(samples.size());
  m.value = mean(samples);
  m.freedom = m.samples - 1;
  double sum = 0.0;
  for (const double s : samples) sum += square(s - m.value);
  m.standard_error = m.samples > 1 ? std::sqrt(sum / m.freedom / m.samples) : kUnknown;
  return m;
}

BekkerFit fit_bekker(std::span<const PlateCurve> plates) {
  FURROW_ASSERT(plates.size() >= 2, plates.size());
  FURROW_ASSERT(
      std::any_of(plates.begin(), plates.end(), [&](const PlateCurve& c) { return c.width != plates[0].width; }),
      plates[0].width);
  const CommonExponent common = fit_exponent(plates);
  BekkerFit fit;
  fit.n = common.n;
  // k_i = k_c/b_i + k_φ: a line through the plates, exact for two.
  std::vector<double> inverse;
  for (std::size_t i = 0; i < plates.size(); ++i) {
    fit.k.push_back(std::exp(common.log_k[i]));
    inverse.push_back(1.0 / plates[i].width);
  }
  const Line line = fit_line(inverse, fit.k);
  fit.k_c = line.slope, fit.k_phi = line.offset;

  double off = 0.0, total = 0.0, count = 0.0, average = 0.0;
  for (const PlateCurve& c : plates)
    for (const double p : c.pressure) average += p, count += 1.0;
  average /= count;
  for (std::size_t i = 0; i < plates.size(); ++i)
    for (std::size_t k = 0; k < plates[i].sinkage.size(); ++k) {
      if (!usable(plates[i], k)) continue;
      off += square(plates[i].pressure[k] - fit.k[i] * std::pow(plates[i].sinkage[k], fit.n));
      total += square(plates[i].pressure[k] - average);
    }
  fit.goodness = total > 0.0 ? 1.0 - off / total : 1.0;
  return fit;
}

PowerFit fit_power(std::span<const PlateCurve> plates) {
  FURROW_ASSERT(!plates.empty(), plates.size());
  const CommonExponent common = fit_exponent(plates);
  PowerFit fit{common.n, 0.0};
  for (const double log_k : common.log_k) fit.k += std::exp(log_k) / static_cast<double>(plates.size());
  return fit;
}

JanosiFit fit_janosi(std::span<const double> travel, std::span<const double> stress) {
  FURROW_ASSERT(travel.size() == stress.size(), travel.size(), stress.size());
  FURROW_ASSERT(travel.size() >= 3, travel.size());
  // For a given K the best τ_max is Σ τ g / Σ g² with g = 1 − exp(−j/K).
  const auto evaluate = [&](double K) {
    double tg = 0.0, gg = 0.0, off = 0.0;
    for (std::size_t k = 0; k < travel.size(); ++k) {
      const double g = -std::expm1(-travel[k] / K);
      tg += stress[k] * g, gg += g * g;
    }
    const double tau = gg > 0.0 ? tg / gg : 0.0;
    for (std::size_t k = 0; k < travel.size(); ++k) off += square(stress[k] + tau * std::expm1(-travel[k] / K));
    return std::pair(off, tau);
  };
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const double j : travel)
    if (j > 0.0) least = std::min(least, j), most = std::max(most, j);
  const double from = std::log(0.1 * least), to = std::log(10.0 * most);
  const auto at = [&](double k) { return from + (to - from) * k / kSearchPoints; };
  int best = 0;
  for (int k = 1; k <= kSearchPoints; ++k)
    if (evaluate(std::exp(at(k))).first < evaluate(std::exp(at(best))).first) best = k;
  double a = at(std::max(best - 1, 0)), b = at(std::min(best + 1, kSearchPoints));
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int k = 0; k < kGoldenSections; ++k) {
    const double c = b - ratio * (b - a), d = a + ratio * (b - a);
    (evaluate(std::exp(c)).first < evaluate(std::exp(d)).first ? b : a) =
        evaluate(std::exp(c)).first < evaluate(std::exp(d)).first ? d : c;
  }
  JanosiFit fit;
  fit.K = std::exp(0.5 * (a + b));
  const auto [off, tau] = evaluate(fit.K);
  fit.tau_max = tau;
  double total = 0.0;
  const double average = mean(stress);
  for (const double t : stress) total += square(t - average);
  fit.goodness = total > 0.0 ? 1.0 - off / total : 1.0;
  return fit;
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
  FURROW_ASSERT(x.size() == y.size() && x.size() >= 2, x.size(), y.size());
  const double mx = mean(x), my = mean(y);
  double xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) xx += square(x[k] - mx), xy += (x[k] - mx) * (y[k] - my);
  Line line;
  line.slope = xy / xx;
  line.offset = my - line.slope * mx;
  return line;
}

Measured fit_friction(std::span<const double> normal, std::span<const double> shear) {
  FURROW_ASSERT(normal.size() == shear.size() && !normal.empty(), normal.size(), shear.size());
  double nn = 0.0, nt = 0.0, off = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k) nn += square(normal[k]), nt += normal[k] * shear[k];
  FURROW_ASSERT(nn > 0.0, nn);
  const double slope = nt / nn;
  for (std::size_t k = 0; k < normal.size(); ++k) off += square(shear[k] - slope * normal[k]);
  const double freedom = static_cast<double>(normal.size()) - 1.0;
  const double error = freedom > 0.0 ? std::sqrt(off / freedom / nn) : kUnknown;
  // dφ = cos² φ d(tan φ)
  return {std::atan(slope), error / (1.0 + square(slope)), static_cast<int>(normal.size()), freedom};
}

CoulombFit fit_coulomb(std::span<const double> normal, std::span<const double> shear) {
  FURROW_ASSERT(normal.size() == shear.size() && normal.size() >= 2, normal.size(), shear.size());
  FURROW_ASSERT(std::adjacent_find(normal.begin(), normal.end(), std::not_equal_to<>()) != normal.end(), normal.size());
  const Line line = fit_line(normal, shear);
  const auto count = static_cast<double>(normal.size());
  const double mx = mean(normal), my = mean(shear);
  double xx = 0.0, off = 0.0, total = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    xx += square(normal[k] - mx);
    off += square(shear[k] - line.offset - line.slope * normal[k]);
    total += square(shear[k] - my);
  }
  const double freedom = count - 2.0, scatter = freedom > 0.0 ? off / freedom : kUnknown;
  const auto measured = [&](double value, double error) {
    return Measured{value, error, static_cast<int>(normal.size()), freedom};
  };
  CoulombFit fit;
  fit.tan_phi = measured(line.slope, std::sqrt(scatter / xx));
  fit.cohesion = measured(line.offset, std::sqrt(scatter * (1.0 / count + mx * mx / xx)));
  // dφ = cos² φ d(tan φ)
  fit.phi = measured(std::atan(line.slope), fit.tan_phi.standard_error / (1.0 + square(line.slope)));
  fit.goodness = total > 0.0 ? 1.0 - off / total : 1.0;
  return fit;
}

}  // namespace furrow::terrain::soil
