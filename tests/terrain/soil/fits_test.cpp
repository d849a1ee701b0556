// Fits against curves that were made from known parameters, and against tables.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "terrain/soil/fits.hpp"

namespace furrow::terrain::soil {
namespace {

PlateCurve bekker_curve(double width, double k_c, double k_phi, double n, double noise, unsigned seed = 1) {
  std::mt19937 bits(seed);
  std::normal_distribution<double> error(0.0, noise);
  PlateCurve c;
  c.width = width;
  for (int i = 1; i <= 200; ++i) {
    const double z = 4e-4 * i;
    c.sinkage.push_back(z);
    c.pressure.push_back((k_c / width + k_phi) * std::pow(z, n) + error(bits));
  }
  return c;
}

TEST(Fits, bekker_parameters_of_exact_curves_come_back) {
  // Dry sand of the Land Locomotion Laboratory [Wong, Theory of Ground Vehicles, Table 2.3].
  const double k_c = 990.0, k_phi = 1528430.0, n = 1.1;
  const std::vector<PlateCurve> plates{bekker_curve(0.05, k_c, k_phi, n, 0.0), bekker_curve(0.1, k_c, k_phi, n, 0.0)};
  const BekkerFit fit = fit_bekker(plates);
  EXPECT_NEAR(fit.n, n, 1e-12);
  EXPECT_NEAR(fit.k_c, k_c, 1e-6 * k_phi * 0.05);
  EXPECT_NEAR(fit.k_phi, k_phi, 1e-9 * k_phi);
  EXPECT_NEAR(fit.goodness, 1.0, 1e-12);
}

TEST(Fits, bekker_fit_ignores_what_no_logarithm_takes) {
  std::vector<PlateCurve> plates{bekker_curve(0.1, 15e3, 250e3, 0.4, 0.0), bekker_curve(0.2, 15e3, 250e3, 0.4, 0.0)};
  plates[0].sinkage.push_back(-0.01), plates[0].pressure.push_back(5e3);
  plates[1].sinkage.push_back(0.01), plates[1].pressure.push_back(-5.0);
  EXPECT_NEAR(fit_bekker(plates).n, 0.4, 1e-12);
}

TEST(Fits, bekker_weights_make_the_error_of_the_pressure_small) {
  // Noise of one size at all depths: the small pressures at small sinkage would dominate unweighted logarithms.
  const std::vector<PlateCurve> plates{bekker_curve(0.1, 15e3, 250e3, 0.7, 1.5e3, 1),
                                       bekker_curve(0.2, 15e3, 250e3, 0.7, 1.5e3, 2)};
  const BekkerFit fit = fit_bekker(plates);
  EXPECT_NEAR(fit.n, 0.7, 0.03);
  EXPECT_NEAR(fit.k[0] * std::pow(0.08, fit.n), 400e3 * std::pow(0.08, 0.7), 1e3);
  EXPECT_GT(fit.goodness, 0.97);
}

TEST(Fits, repeated_plates_average_their_moduli) {
  const std::vector<PlateCurve> plates{
      bekker_curve(0.1, 15e3, 240e3, 0.5, 0.0), bekker_curve(0.2, 15e3, 240e3, 0.5, 0.0),
      bekker_curve(0.1, 15e3, 260e3, 0.5, 0.0), bekker_curve(0.2, 15e3, 260e3, 0.5, 0.0)};
  const BekkerFit fit = fit_bekker(plates);
  EXPECT_NEAR(fit.k_phi, 250e3, 1.0);
  EXPECT_NEAR(fit.k_c, 15e3, 1.0);
}

TEST(Fits, power_law_of_plates_of_one_size_comes_back) {
  PlateCurve curve;
  curve.width = 0.03;
  for (int k = 0; k <= 40; ++k)
    curve.sinkage.push_back(5e-4 * k), curve.pressure.push_back(3e5 * std::pow(5e-4 * k, 0.8));
  PlateCurve harder = curve;
  for (double& p : harder.pressure) p *= 1.5;
  const PowerFit fit = fit_power(std::vector{curve, harder});
  EXPECT_NEAR(fit.n, 0.8, 1e-12);
  EXPECT_NEAR(fit.k, 1.25 * 3e5, 1e-6);
}

TEST(Fits, janosi_parameters_of_an_exact_curve_come_back) {
  for (const double K : {0.002, 0.02, 0.2}) {
    std::vector<double> j, tau;
    for (int i = 0; i < 200; ++i) {
      j.push_back(4e-4 * (i + 0.5));
      tau.push_back(30e3 * (1.0 - std::exp(-j.back() / K)));
    }
    const JanosiFit fit = fit_janosi(j, tau);
    EXPECT_NEAR(fit.K, K, 1e-6 * K);
    EXPECT_NEAR(fit.tau_max, 30e3, 30.0);
    EXPECT_NEAR(fit.goodness, 1.0, 1e-9);
  }
}

TEST(Fits, janosi_fit_of_noise_without_strength_is_finite) {
  std::vector<double> j, tau;
  std::mt19937 bits(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int i = 0; i < 100; ++i) j.push_back(1e-3 * (i + 1)), tau.push_back(noise(bits));
  const JanosiFit fit = fit_janosi(j, tau);
  EXPECT_TRUE(std::isfinite(fit.K) && std::isfinite(fit.tau_max));
  EXPECT_LT(std::abs(fit.tau_max), 1.0);
}

TEST(Fits, coulomb_line_and_its_errors_match_the_textbook_formulas) {
  // Three points, residuals +1, −2, +1 about 2 + 0.5 x: s² = 6/1, s_slope = √(6/2), s_offset = √(6 (1/3 + 4/2)).
  const std::vector<double> x{1.0, 2.0, 3.0}, y{3.5, 1.0, 4.5};
  const CoulombFit fit = fit_coulomb(x, y);
  EXPECT_NEAR(fit.tan_phi.value, 0.5, 1e-12);
  EXPECT_NEAR(fit.cohesion.value, 2.0, 1e-12);
  EXPECT_NEAR(fit.tan_phi.standard_error, std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(fit.cohesion.standard_error, std::sqrt(14.0), 1e-12);
  EXPECT_NEAR(fit.phi.value, std::atan(0.5), 1e-12);
  EXPECT_NEAR(fit.phi.standard_error, std::sqrt(3.0) / 1.25, 1e-12);
  EXPECT_EQ(fit.cohesion.freedom, 1.0);
}

TEST(Fits, two_loads_give_a_line_without_an_error) {
  const CoulombFit fit = fit_coulomb(std::vector<double>{1e4, 2e4}, std::vector<double>{6e3, 1e4});
  EXPECT_NEAR(fit.cohesion.value, 2e3, 1e-6);
  EXPECT_TRUE(std::isnan(fit.cohesion.half_interval()));
}

TEST(Fits, mean_and_its_error) {
  const Measured m = mean_of(std::vector<double>{1.0, 2.0, 3.0});
  EXPECT_NEAR(m.value, 2.0, 1e-15);
  EXPECT_NEAR(m.standard_error, 1.0 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(m.half_interval(), 4.30265 / std::sqrt(3.0), 1e-4);
  EXPECT_TRUE(std::isnan(mean_of(std::vector<double>{5.0}).half_interval()));
}

}  // namespace
}  // namespace furrow::terrain::soil
