// The planar tire compared with the results of its source: Štiavnický, Enhanced tire model for vibration analysis of
// vehicle, Science & Military 2/2010. Radii, mesh and disc are ours (tire/data/aligator_planar.json), so numbers that
// depend on them are printed next to the source's and not judged.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/tire/verification/planar_cases.hpp"
#include "tests/tire/verification/planar_curb.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

constexpr double kDeflection = 0.08;         // m
constexpr double kMeasured = 639782.0;       // N/m, radial stiffness of the Aligator's tire
constexpr double kPapersModulus = 295740.0;  // Pa, at ν = 0.45 in the source's mesh

/// The file that an environment variable names, with its header; a closed stream if the variable is not set.
std::ofstream table(const char* variable, const char* header) {
  std::ofstream out;
  if (const char* path = std::getenv(variable); path != nullptr && *path != '\0') out.open(path);
  out << header << "\n";
  return out;
}

TEST(Planar, compression_to_80_mm_is_the_stiffer_the_less_the_volume_can_change) {
  std::ofstream out = table("FURROW_PLANAR_COMPRESSION_CSV", "poisson_ratio,deflection_m,force_N");
  double before = 0.0;
  for (const double poisson : {0.15, 0.3, 0.45}) {
    tire::PlanarParams p = aligator();
    p.tire.young_modulus = kPapersModulus, p.tire.poisson_ratio = poisson;
    const Compression c = compressed(p, kDeflection, 16);
    for (const auto& [deflection, force] : c.curve)
      out << fmt::format("{:g},{:.6g},{:.8g}\n", poisson, deflection, force);
    for (std::size_t k = 1; k < c.curve.size(); ++k) EXPECT_GT(c.curve[k].second, c.curve[k - 1].second);
    EXPECT_GT(c.secant(), before);
    before = c.secant();
  }
  // The source's figure ends at 1e5 N; the scale is that of forces at these moduli.
  EXPECT_GT(before * kDeflection, 2e4);
  EXPECT_LT(before * kDeflection, 1e5);
}

/// Straight line y = intercept + slope x of least squares, and the share of y's variance that it explains.
struct Line {
  double slope, intercept, r_squared;
};
Line fitted(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double sum_x = 0.0, sum_y = 0.0, xx = 0.0, xy = 0.0, residual = 0.0, total = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) sum_x += x[k], sum_y += y[k], xx += x[k] * x[k], xy += x[k] * y[k];
  const double slope = (xy - sum_x * sum_y / n) / (xx - sum_x * sum_x / n), intercept = (sum_y - slope * sum_x) / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double off = y[k] - intercept - slope * x[k], from_mean = y[k] - sum_y / n;
    residual += off * off, total += from_mean * from_mean;
  }
  return {slope, intercept, 1.0 - residual / total};
}

TEST(Planar, radial_stiffness_is_linear_in_the_modulus) {
  std::ofstream out = table("FURROW_PLANAR_MODULUS_CSV", "young_modulus_Pa,secant_N_per_m,regression_N_per_m");
  verification::Worst line("planar tire: stiffness against modulus",
                           "secant at 80 mm beside that at 1e5 Pa in proportion", 0.08, "linear [Stiavnicky 2010]");
  double first = 0.0;
  std::vector<double> modulus, secant, regression;
  for (int k = 1; k <= 10; ++k) {
    tire::PlanarParams p = aligator();
    p.tire.young_modulus = 1e5 * k;
    const Compression c = compressed(p, kDeflection, 8);
    out << fmt::format("{:g},{:.8g},{:.8g}\n", p.tire.young_modulus, c.secant(), c.regression());
    modulus.push_back(p.tire.young_modulus), secant.push_back(c.secant()), regression.push_back(c.regression());
    if (k == 1) first = c.secant();
    line.add(c.secant(), k * first);
    if (k == 10) {  // 2.2 to 2.5e6 N/m in the source
      EXPECT_GT(c.secant(), 1.5e6);
      EXPECT_LT(c.secant(), 3.5e6);
    }
  }
  std::ofstream fit = table("FURROW_PLANAR_LINE_CSV", "stiffness_by,slope_m,intercept_N_per_m,r_squared");
  for (const bool by_regression : {false, true}) {
    const Line f = fitted(modulus, by_regression ? regression : secant);
    fit << fmt::format("{},{:.6g},{:.6g},{:.6f}\n", by_regression ? "regression" : "ends", f.slope, f.intercept,
                       f.r_squared);
    verification::verify("planar tire: stiffness against modulus",
                         by_regression ? "R² of a straight line, by regression" : "R² of a straight line, by ends",
                         f.r_squared, 1.0, 1e-3, "linear [Stiavnicky 2010]");
  }
}

/// Limit of three values on meshes each twice as fine as the one before, and the order at which they approach it.
struct Limit {
  double value, order;
};
Limit extrapolated(double coarse, double middle, double fine) {
  const double ratio = (coarse - middle) / (middle - fine);
  return {fine - (middle - fine) / (ratio - 1.0), std::log2(ratio)};
}

TEST(Planar, finer_meshes_are_softer_and_averaged_volumes_show_that_it_is_locking) {
  std::ofstream out = table("FURROW_PLANAR_MESH_CSV",
                            "volume,around,radial,elements,secant_N_per_m,regression_N_per_m,limit_N_per_m,order");
  std::array<Limit, 2> limit{};
  std::array<double, 2> change{};
  for (const bool averaged : {false, true}) {
    std::vector<double> secant;
    for (int around = 18; around <= 144; around *= 2) {
      tire::PlanarParams p = meshed(aligator(), around);
      p.options.averaged = averaged;
      const Compression c = compressed(p, kDeflection, 8);
      secant.push_back(c.secant());
      const std::size_t n = secant.size();
      if (n >= 3) limit[averaged] = extrapolated(secant[n - 3], secant[n - 2], secant[n - 1]);
      out << fmt::format("{},{},{},{},{:.8g},{:.8g},", averaged ? "averaged" : "element", around, p.size.rings,
                         c.elements, c.secant(), c.regression());
      out << (n >= 3 ? fmt::format("{:.8g},{:.3g}\n", limit[averaged].value, limit[averaged].order) : ",\n");
      EXPECT_TRUE(n == 1 || averaged || secant[n - 1] < secant[n - 2]);
    }
    change[averaged] = secant[1] / secant[2] - 1.0;
  }
  // Four times the elements: about 10 % in the source.
  EXPECT_GT(change[0], 0.01);
  EXPECT_LT(change[0], 0.15);
  EXPECT_LT(std::abs(change[1]), 0.5 * change[0]);
  verification::verify("planar tire: limit of fine meshes", "secant at 80 mm, N/m, elements beside averaged volumes",
                       limit[0].value, limit[1].value, 0.02, "each other");
}

TEST(Planar, modulus_for_the_measured_stiffness) {
  std::ofstream out = table("FURROW_PLANAR_FIT_CSV",
                            "law,volume,stiffness_by,young_modulus_Pa,stiffness_N_per_m,source_young_modulus_Pa");
  for (const auto law : {tire::PlanarLaw::consistent, tire::PlanarLaw::printed})
    for (const bool averaged : {false, true})
      for (const bool by_regression : {false, true}) {
        tire::PlanarParams p = aligator();
        p.options.law = law, p.options.averaged = averaged;
        double stiffness = 0.0;
        for (int trial = 0; trial < 3; ++trial) {  // nearly linear
          const Compression c = compressed(p, kDeflection, 8);
          stiffness = by_regression ? c.regression() : c.secant();
          if (trial < 2) p.tire.young_modulus *= kMeasured / stiffness;
        }
        out << fmt::format("{},{},{},{:.6g},{:.8g},{:g}\n", law == tire::PlanarLaw::printed ? "printed" : "consistent",
                           averaged ? "averaged" : "element", by_regression ? "regression" : "ends",
                           p.tire.young_modulus, stiffness, kPapersModulus);
        EXPECT_NEAR(stiffness, kMeasured, 2e-3 * kMeasured);
        EXPECT_GT(p.tire.young_modulus, 0.5 * kPapersModulus);
        EXPECT_LT(p.tire.young_modulus, 2.0 * kPapersModulus);
      }
}

TEST(Planar, a_curb_is_climbed_before_the_centre_is_there_and_nearly_left_behind_it) {
  const QuarterCar car;
  const CurbRun run = drive_over_curb(aligator(), car, {-0.35, -0.15, 0.1}, 100);
  std::ofstream out = table("FURROW_PLANAR_CURB_CSV",
                            "time_s,centre_x_m,axle_m,body_m,ground_force_N,simple_axle_m,simple_ground_force_N");
  double lightest = 1e9, highest = 0.0, before = 0.0, simple_before = 0.0, largest_way = 0.0, simple_largest_way = 0.0;
  for (std::size_t k = 0; k < run.lines.size(); ++k) {
    const CurbLine& l = run.lines[k];
    out << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", (l.x - car.from) / car.speed, l.x, l.axle,
                       l.body, l.force, l.simple_axle, l.simple_force);
    highest = std::max(highest, l.axle);
    if (l.x > -1.0) lightest = std::min(lightest, l.force);
    if (l.x < 0.0) before = l.axle, simple_before = l.simple_axle;
    if (k == 0 || l.x < -1.0) continue;
    largest_way = std::max(largest_way, std::abs(l.axle - run.lines[k - 1].axle));
    simple_largest_way = std::max(simple_largest_way, std::abs(l.simple_axle - run.lines[k - 1].simple_axle));
  }
  std::ofstream shapes = table("FURROW_PLANAR_SHAPES_CSV", "centre_x_m,ring,node,x_m,z_m");
  const int around = static_cast<int>(run.mesh.outer.size()), nodes = run.mesh.nodes();
  const int rings = aligator().size.rings;
  for (const CurbRun::Picture& picture : run.pictures)
    for (int ring = 0; ring <= rings; ++ring)
      for (int j = 0; j < around; ++j) {  // the tire's own nodes are the last, ring by ring
        const int n = ring == 0 ? run.mesh.rim[j] : nodes - (rings - ring + 1) * around + j;
        shapes << fmt::format("{:.4g},{},{},{:.5g},{:.5g}\n", picture.x, ring, j, picture.nodes.x[n],
                              picture.nodes.z[n]);
      }
  // A rigid circle of its size touches at √(R² − (R − 0.2)²) before the edge.
  const double radius = aligator().size.radius;
  const double rigid = -std::sqrt(radius * radius - (radius - car.curb) * (radius - car.curb));
  EXPECT_NEAR(run.first_touch, rigid, 0.06);
  EXPECT_GE(run.simple_first, 0.0);
  EXPECT_GT(before, 0.3 * car.curb);
  EXPECT_NEAR(simple_before, 0.0, 1e-9);
  EXPECT_GT(highest, car.curb);
  // The source's wheel may leave the ground; with these values its load falls below a quarter.
  EXPECT_LT(lightest, 0.25 * (car.axle + car.body) * 9.81);
  EXPECT_LT(largest_way, simple_largest_way);  // it climbs continuously
  EXPECT_NEAR(run.lines.back().simple_axle, car.curb, 0.1);
}

}  // namespace
}  // namespace furrow::test
