// The soil tests on small boxes: balances and known limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "terrain/dem/dem_terrain.hpp"
#include "terrain/soil/cone.hpp"
#include "terrain/soil/direct_shear.hpp"
#include "terrain/soil/plate_sinkage.hpp"
#include "terrain/soil/repose.hpp"
#include "terrain/soil/soil_tests.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr Box kShearBox{24.0, 10.0, 12.0};

dem::DemOptions coarse(double cohesion = 80e3) {
  dem::DemOptions o;
  o.radius = 0.01;
  o.cohesion = cohesion;
  return o;
}

void ignore(double) {}

ShearResult sheared(const dem::DemOptions& material, double normal_stress, double travel = 6.0) {
  ShearTest test;
  test.normal_stress = normal_stress;
  test.travel = travel;
  test.samples = 50;  // of which 12.5 are a quarter
  return direct_shear(Specimen(material, kShearBox, 1, ignore), test, ignore);
}

/// Signed volume of a closed mesh, or the flux of x through an open one: shows which way the triangles face.
Vec3 area_vector(const Tool& tool) {
  Vec3 sum = Vec3::Zero();
  for (const auto& t : tool.mesh().triangles) {
    const auto& x = tool.state().position;
    sum += 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  }
  return sum;
}

TEST(SoilTools, faces_look_outwards) {
  EXPECT_NEAR((area_vector(strip_plate(0.5, 0.2, 0.1, 0.3, 0.1)) - Vec3(0.0, 0.0, -0.04)).norm(), 0.0, 1e-15);
  const Vec3 circle(0.0, 0.0, -std::numbers::pi * 0.01);
  EXPECT_NEAR((area_vector(disc_plate(0.5, 0.1, 0.2, 0.3, 0.1)) - circle).norm(), 0.0, 1e-15);
  EXPECT_NEAR((area_vector(toothed_sheet(0.0, 1.2, 0.1, 0.0, 0.06, 0.015, 1)) - Vec3(0, 0, 0.24)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((area_vector(toothed_sheet(0.0, 1.2, 0.1, 0.0, 0.06, 0.015, -1)) + Vec3(0, 0, 0.24)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((area_vector(flat_sheet(0.0, 1.2, 0.1, 0.3)) + Vec3(0, 0, 0.24)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((area_vector(studded_sheet(0.0, 1.2, 0.1, 0.3, 0.01)) + Vec3(0, 0, 0.24)).norm(), 0.0, 1e-4);
  const Tool cone = cone_on_shaft(Vec3(0.0, 0.0, 0.0), 0.06, kConeAngle, kConeShaft, 0.1);
  EXPECT_LT(area_vector(cone).norm(), 1e-15);  // closed
  double volume = 0.0;
  for (const auto& t : cone.mesh().triangles) {
    const auto& x = cone.state().position;
    volume += x[t[0]].dot(x[t[1]].cross(x[t[2]])) / 6.0;
  }
  const double expected = cone_base_area(0.06) * (cone_height(0.06, kConeAngle) / 3.0 + 0.1 * kConeShaft * kConeShaft);
  EXPECT_NEAR(volume, expected, 1e-9 * expected);
  EXPECT_NEAR(cone_base_area(0.06), std::numbers::pi * 0.0009, 0.02 * std::numbers::pi * 0.0009);
}

TEST(SoilTools, teeth_repeat_with_the_cell) {
  // A sheet that reaches beyond the cell on both sides has its teeth one period apart.
  const Tool sheet = toothed_sheet(-0.03, 0.27, 0.1, 0.0, 0.06, 0.015, 1);
  std::vector<double> tips;
  for (const Vec3& x : sheet.state().position)
    if (x.z() > 0.0 && x.y() > 0.0) tips.push_back(x.x());
  ASSERT_GE(tips.size(), 4u);
  for (std::size_t k = 1; k < tips.size(); ++k) EXPECT_NEAR(tips[k] - tips[k - 1], 0.06, 1e-12);
  EXPECT_NEAR(std::remainder(tips.front() - 0.03, 0.06), 0.0, 1e-12);
}

TEST(DirectShear, lid_bears_its_load_and_the_floor_bears_lid_and_soil) {
  const ShearResult r = sheared(coarse(), 50e3);
  EXPECT_NEAR(r.normal_mean, 50e3, 0.03 * 50e3);
  EXPECT_LT(r.floor_error, 0.01);  // floor force = weight + load
  EXPECT_LT(r.shear_error, 0.03);  // the pull on the lid holds the lower plate
  ASSERT_EQ(r.shear.size(), 50U);
  EXPECT_NEAR(r.final_shear, std::accumulate(r.shear.end() - 12, r.shear.end(), 0.0) / 12.0, 1e-9 * r.final_shear);
  EXPECT_GT(r.final_shear, 0.0);
  EXPECT_GT(r.janosi.K, 0.001);
  EXPECT_LT(r.janosi.K, 0.1);
}

TEST(DirectShear, strength_vanishes_for_frictionless_grains_without_cohesion) {
  // The remaining resistance is geometric, of frictionless spheres, tan φ = 0.1 [Peyneau & Roux 2008, φ = 5.76°,
  // doi:10.1103/PhysRevE.78.011307].
  dem::DemOptions smooth = coarse(0.0);
  smooth.friction = 0.0;
  const ShearResult r = sheared(smooth, 50e3);
  EXPECT_LT(std::abs(r.final_shear) / r.normal_mean, 0.2);
  EXPECT_LT(r.final_shear / r.normal_mean, 0.5 * sheared(coarse(0.0), 50e3).final_shear / 50e3);
}

TEST(DirectShear, higher_cohesion_gives_higher_strength_at_low_load) {
  const double none = sheared(coarse(0.0), 20e3).final_shear, much = sheared(coarse(160e3), 20e3).final_shear;
  EXPECT_GT(much, none + 5e3);
}

TEST(DirectShear, grains_slide_along_a_smooth_plate_and_lock_with_a_glued_one) {
  const dem::DemOptions material = coarse(0.0);
  const Specimen specimen(material, kShearBox, 1, ignore);
  const auto along = [&](Face face) {
    ShearTest test{.normal_stress = 20e3, .travel = 8.0, .samples = 60, .face = face};
    test.friction = 0.1;
    return direct_shear(specimen, test, ignore);
  };
  const ShearResult flat = along(Face::flat), glued = along(Face::glued);
  EXPECT_NEAR(flat.final_shear / flat.normal_mean, 0.1, 0.005);
  EXPECT_GT(flat.sliding, 0.9);
  EXPECT_LT(flat.roll, 0.2);
  EXPECT_GT(glued.final_shear, 1.5 * flat.final_shear);
}

TEST(PlateSinkage, floor_bears_plate_and_soil_and_pressure_grows) {
  const Specimen specimen(coarse(), {40.0, 8.0, 16.0}, 1, ignore);
  PlateTest test;
  test.width = 8.0;
  test.sinkage = 3.0;
  test.samples = 30;
  const PlateResult r = plate_sinkage(specimen, test, ignore);
  EXPECT_LT(r.balance_error, 0.05);
  ASSERT_EQ(r.curve.sinkage.size(), 30u);
  EXPECT_NEAR(r.curve.sinkage.back(), 0.03, 1e-3);
  EXPECT_GT(r.curve.pressure.back(), r.curve.pressure[5]);
  EXPECT_NEAR(r.curve.width, 0.08, 1e-15);
}

TEST(PlateSinkage, floor_bears_a_disc_and_displaced_volume_is_heaved_or_compacted) {
  const Specimen specimen(coarse(0.0), {40.0, 40.0, 14.0}, 1, ignore);
  PlateTest test{.width = 12.0, .sinkage = 3.0, .speed = 0.2, .samples = 60, .disc = true, .unload = true};
  const PlateResult r = plate_sinkage(specimen, test, ignore);
  EXPECT_LT(r.balance_error, 0.05);
  EXPECT_NEAR(r.curve.width, 0.06, 1e-15);  // b is the radius
  EXPECT_NEAR(r.volume.displaced, std::numbers::pi * 0.0036 * 0.03, 1e-9);
  EXPECT_LT(std::abs(r.volume.residual()), 0.1 * r.volume.displaced);
  EXPECT_LT(std::abs(r.unloaded.residual()), 0.15 * r.unloaded.displaced);
  EXPECT_GT(r.rebound, 0.0);
  EXPECT_NEAR(r.unloaded.displaced, r.volume.displaced - std::numbers::pi * 0.0036 * r.rebound, 1e-9);
  // Such a bed may grow looser as it is sheared; both are fractions of the same space.
  EXPECT_NEAR(r.volume.solid_after, r.volume.solid_before, 0.05);
}

TEST(ConePenetration, pressure_grows_from_nothing) {
  const Specimen specimen(coarse(), {20.0, 20.0, 18.0}, 1, ignore);
  ConeTest test;
  test.diameter = 4.0, test.depth = 2.0, test.index_from = 1.0, test.index_to = 2.0;
  test.samples = 40;
  const ConeResult r = cone_penetration(specimen, test, ignore);
  EXPECT_LT(std::abs(r.pressure.front()), 0.2 * r.index);
  EXPECT_GT(r.index, 10e3);
  EXPECT_NEAR(r.depth.back(), 0.02, 2e-3);  // the last interval's middle
  EXPECT_NEAR(r.reached, 0.02, 1e-12);
  EXPECT_GT(r.gradient, 0.0);
  EXPECT_TRUE(0.0 < r.mean && r.mean < r.index) << r.mean;
  test.depth = 100.0;  // the point stays a diameter above the floor
  const double height = specimen.height() - cone_height(0.04, kConeAngle);
  EXPECT_NEAR(cone_penetration(specimen, test, ignore).reached, height - 0.04, 1e-12);
  test.diameter = 10.0;
  EXPECT_THROW(cone_penetration(specimen, test, ignore), Error);
}

TEST(Repose, slope_of_a_plane_comes_back_and_a_cut_is_steep) {
  std::vector<double> x, slope, cut;
  for (int k = 0; k < 60; ++k) {
    x.push_back(0.02 * (k + 0.5));
    slope.push_back(std::max(0.04, std::min(0.30, 0.50 - std::tan(0.4) * x.back())));
    cut.push_back(k < 30 ? 0.30 : 0.04);
  }
  EXPECT_NEAR(flank_angle(x, slope, 0.04), 0.4, 1e-9);
  EXPECT_GT(flank_angle(x, cut, 0.04), 80.0 / 180.0 * std::numbers::pi);
}

TEST(Repose, cohesive_cut_stands_and_dry_one_slumps) {
  ReposeTest test;
  test.cut = 20.0;
  const Box box{60.0, 8.0, 14.0, false, true};
  const ReposeResult stands = angle_of_repose(Specimen(coarse(), box, 1, ignore), test, ignore);
  const ReposeResult slumps = angle_of_repose(Specimen(coarse(0.0), box, 1, ignore), test, ignore);
  EXPECT_FALSE(stands.slumped);
  EXPECT_TRUE(slumps.slumped);
  EXPECT_GT(stands.angle, 1.0);
  EXPECT_GT(slumps.angle, 0.2);
  EXPECT_LT(slumps.angle, 0.7);
}

SoilOptions quick(int threads) {
  SoilOptions o;
  o.material = coarse(0.0);
  o.quick = true;
  o.seeds = 1;
  o.speed = 0.3;
  o.threads = threads;
  o.plate = o.cone = false;
  return o;
}

TEST(SoilTests, results_do_not_depend_on_threads) {
  const SoilPlan plan = soil_plan(quick(1));
  const SoilResults one = run_soil_tests(quick(1), plan, {}), two = run_soil_tests(quick(2), plan, {});
  ASSERT_EQ(one.shear.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(one.shear[k].result.shear, two.shear[k].result.shear);
  EXPECT_EQ(one.repose[0].result.after, two.repose[0].result.after);
  EXPECT_TRUE(one.dry.empty());  // the grains have no cohesion to do without
  const SoilParameters p = soil_parameters(one, plan, 0.01);
  EXPECT_EQ(p.cohesion.samples, 3);
  EXPECT_EQ(p.n.samples, 0);
}

TEST(SoilTests, progress_may_stop_them) {
  int calls = 0;
  const auto stop = [&](const std::string&, double) {
    if (++calls == 2) throw Error(ExitCode::stopped, "enough");
  };
  EXPECT_THROW(run_soil_tests(quick(2), soil_plan(quick(2)), stop), Error);
}

/// The pressure on a cone grows with its depth, so both indices need equal depths.
TEST(SoilTests, the_quick_cone_index_is_of_the_same_depths) {
  SoilOptions whole = quick(1);
  whole.quick = false;
  const SoilPlan small = soil_plan(quick(1)), full = soil_plan(whole);
  ASSERT_EQ(small.cones.size(), full.cones.size());
  for (std::size_t k = 0; k < small.cones.size(); ++k) {
    EXPECT_EQ(small.cones[k].index_from, full.cones[k].index_from);
    EXPECT_EQ(small.cones[k].index_to, full.cones[k].index_to);
    EXPECT_GE(small.cones[k].depth, small.cones[k].index_to);
    EXPECT_GT(small.cone_box.depth, 2.0 * small.cones[k].depth);
  }
}

TEST(SoilTests, plates_in_metres_stand_on_beds_of_the_wanted_depths) {
  SoilOptions o = quick(1);
  o.quick = o.shear = o.repose = false;
  o.plate = true;
  o.material.size_spread = 0.3;
  o.discs = {0.08, 0.12}, o.depths = {0.12, 0.2}, o.sinkage = 0.025, o.bed_width = 0.3, o.speed = 0.5;
  const SoilPlan plan = soil_plan(o);
  ASSERT_EQ(plan.plate_beds.size(), 2u);
  EXPECT_EQ(plan.deepest(), 1u);
  EXPECT_NEAR(plan.plate_beds[0].box.length, 30.0, 1e-12);
  const SoilResults results = run_soil_tests(o, plan, {});
  for (std::size_t bed = 0; bed < 2; ++bed) {
    ASSERT_EQ(results.plate[bed].size(), 2u);
    EXPECT_NEAR(results.plate[bed][0].specimen.height, o.depths[bed], 0.06 * o.depths[bed]);
  }
  const SoilParameters p = soil_parameters(results, plan, 0.01);
  ASSERT_EQ(p.plates.size(), 4u);
  EXPECT_EQ(p.k_c.value, p.beds[1].k_c.value);
  // Both fits use the same points.
  EXPECT_NEAR(p.plates[3].k.value * std::pow(0.025, p.plates[3].n.value),
              results.plate[1][1].result.curve.pressure.back(), 0.3 * results.plate[1][1].result.curve.pressure.back());
}

TEST(SoilTests, the_scenarios_own_bed_is_taken_as_it_is) {
  dem::DemOptions o = coarse(0.0);
  o.length = 0.5, o.width = 0.3, o.layers = 6, o.cache = false;
  const Specimen specimen(o, {.own = true}, 1, ignore);
  const auto bed = make_dem_terrain(o);
  bed->prepare({});
  EXPECT_EQ(specimen.grains(), bed->size());
  EXPECT_EQ(specimen.height(), bed->gather_mean_height(0.0, 0.5, -0.15, 0.15));
}

TEST(SoilTests, loads_suit_soft_grains) {
  SoilOptions o = quick(1);
  EXPECT_EQ(soil_plan(o).shears.back().normal_stress, 100e3);
  o.material.young_modulus = 1e6;
  EXPECT_EQ(soil_plan(o).shears.back().normal_stress, 5e3);
}

}  // namespace
}  // namespace furrow::terrain::soil
