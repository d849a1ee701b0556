// soil.json of results that were made from known parameters.
#include "terrain/soil/soil_output.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace furrow::terrain::soil {
namespace {

using json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180.0;  // rad

struct Truth {
  double value = 0.0, scatter = 0.0;  // of one test, or of one bed
};
/// Approximate results of `furrow soil` for cohesive grains, with the names of soil.json.
const std::map<std::string, Truth> kTruth{{"cohesion_Pa", {6.8e3, 0.0}},     {"friction_angle_deg", {26.5, 0.0}},
                                          {"janosi_K_m", {0.02, 0.003}},     {"cone_index_Pa", {80e3, 8e3}},
                                          {"repose_angle_deg", {24.0, 1.0}}, {"k_c", {15e3, 3e3}},
                                          {"k_phi", {240e3, 10e3}}};
constexpr double kSinkageExponent = 0.4;
constexpr double kShearScatter = 1.5e3;  // of τ_max of one test, Pa

/// Tests on beds that scatter about the truth.
class Draws {
 public:
  Draws() {
    options.material.radius = 0.01;
    plan = soil_plan(options);
  }

  SoilResults draw() {
    SoilResults results;
    for (int s = 0; s < options.seeds; ++s) {
      for (const ShearTest& test : plan.shears) results.shear.push_back({{}, shear(test.normal_stress)});
      const double k_c = of("k_c"), k_phi = of("k_phi");
      results.plate.resize(1);
      for (const PlateTest& test : plan.plate_beds[0].plates)
        results.plate[0].push_back({{}, plate(test.width * options.material.radius, k_c, k_phi)});
      ConeResult cone;
      cone.index = of("cone_index_Pa");
      for (std::size_t k = 0; k < plan.cones.size(); ++k) results.cone.push_back({{}, cone});
      ReposeResult repose;
      repose.angle = of("repose_angle_deg") * kDegree;
      results.repose.push_back({{}, repose});
    }
    return results;
  }

  json soil() {
    const SoilResults results = draw();
    return soil_json({"small", "0", options, plan, results});
  }

  SoilOptions options;
  SoilPlan plan;

 private:
  double of(const char* name) { return kTruth.at(name).value + kTruth.at(name).scatter * normal_(bits_); }

  ShearResult shear(double stress) {
    ShearResult r;
    const double strength =
        kTruth.at("cohesion_Pa").value + stress * std::tan(kTruth.at("friction_angle_deg").value * kDegree);
    r.normal_mean = stress;
    r.janosi.tau_max = r.final_shear = strength + kShearScatter * normal_(bits_);
    r.janosi.K = of("janosi_K_m");
    r.height = 0.1;
    r.rise = {0.0};
    return r;
  }
  static PlateResult plate(double width, double k_c, double k_phi) {
    PlateResult result;
    PlateCurve& curve = result.curve;
    curve.width = width;
    for (int i = 1; i <= 50; ++i) {
      curve.sinkage.push_back(2e-3 * i);
      curve.pressure.push_back((k_c / width + k_phi) * std::pow(curve.sinkage.back(), kSinkageExponent));
    }
    result.volume.displaced = width * 0.1;
    return result;
  }

  std::mt19937 bits_{1};
  std::normal_distribution<double> normal_;
};

TEST(SoilOutput, intervals_of_95_percent_cover_the_truth_in_95_percent_of_all_draws) {
  constexpr int kDraws = 1000;
  Draws draws;
  std::map<std::string, int> covered;
  for (int k = 0; k < kDraws; ++k) {
    const json soil = draws.soil();
    for (const auto& [name, truth] : kTruth) {
      const json& interval = soil["interval_95"][name];
      ASSERT_TRUE(interval.is_array()) << name << ": " << soil["no_interval_because"].dump();
      covered[name] += interval[0] <= truth.value && truth.value <= interval[1];
    }
  }
  // Four standard deviations of a share of 0.95 in a thousand draws are 0.028.
  for (const auto& [name, count] : covered) EXPECT_NEAR(count / double{kDraws}, 0.95, 0.028) << name;
}

TEST(SoilOutput, where_an_interval_would_not_cover_there_is_none) {
  Draws draws;
  draws.options.quick = true;
  for (const auto& [name, truth] : kTruth) {
    const json soil = draws.soil();
    EXPECT_TRUE(soil["interval_95"][name].is_null() && soil["standard_error"][name].is_null()) << name;
  }
  draws.options.quick = false;
  draws.options.seeds = 1;
  const json soil = draws.soil();
  for (const auto& [name, truth] : kTruth) {
    if (name == "janosi_K_m") continue;  // three tests of its own on one bed
    EXPECT_TRUE(soil["interval_95"][name].is_null()) << name;
  }
}

}  // namespace
}  // namespace furrow::terrain::soil
