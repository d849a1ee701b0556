// Plans the tests and their beds: SoilPlan of soil_tests.hpp.
#include <algorithm>
#include <vector>

#include "terrain/dem/beds/loaded_lid.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/soil/soil_tests.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr int kMetreSamples = 300;        // of the curve of a plate given in metres
constexpr double kStripLength = 10.0;     // of strips, radii
constexpr double kConeDepth = 0.15;       // depth of the mean of a cone given in metres [Brixius 1987], m
constexpr double kConeWidths = 6.0;       // width of the bed in diameters of the largest cone
constexpr double kLeastConeWidth = 24.0;  // radii

/// Widens periodic boxes to three cells of the neighbour search, as grains must not touch their own images.
void widen(const SoilOptions& o, Box& box) {
  const double least = 6.0001 * (dem::largest_radius(o.material) / o.material.radius + dem::kSkinShare);
  if (box.periodic_x) box.length = std::max(box.length, least);
  if (box.periodic_y) box.width = std::max(box.width, least);
}

void plan_plates(const SoilOptions& o, SoilPlan& plan) {
  if (o.discs.empty() && o.strips.empty()) {
    PlateBed bed;
    if (o.quick) bed.box = {40.0, 8.0, 16.0};
    for (const double width : o.quick ? std::vector{5.0, 10.0} : std::vector{10.0, 20.0}) {
      PlateTest test;
      test.width = width;
      test.speed = o.speed;
      if (o.quick) test.sinkage = 4.0, test.samples = 50;
      bed.plates.push_back(test);
    }
    plan.plate_beds = {bed};
    return;
  }
  double least = 1e300, most = 0.0;  // m
  for (const auto* sizes : {&o.discs, &o.strips})
    for (const double size : *sizes) least = std::min(least, size), most = std::max(most, size);
  const double sinkage = o.sinkage > 0.0 ? o.sinkage : kSinkage * least;
  std::vector<PlateTest> plates;
  for (const double width : o.strips) plates.push_back(plate_test(o, width, false, sinkage));
  for (const double diameter : o.discs) plates.push_back(plate_test(o, diameter, true, sinkage));
  for (const double depth : o.own_bed || o.depths.empty() ? std::vector{kDepths * most} : o.depths)
    plan.plate_beds.push_back(plate_bed(o, plates, depth));
  plan.plate_from = 2.0;
}

/// Plans cones that are evaluated between the same depths, as pressure grows with depth.
void plan_cones(const SoilOptions& o, SoilPlan& plan) {
  const double r = o.material.radius;
  const auto add = [&](double diameter) {
    ConeTest test{.diameter = diameter, .speed = o.speed};
    if (o.quick) test.samples = 50;
    if (!o.cones.empty() || o.own_bed) test.depth = test.index_to = kConeDepth / r, test.index_from = 0.0;
    plan.cones.push_back(test);
  };
  double widest = 0.0;  // m
  for (const double diameter : o.cones) add(diameter / r), widest = std::max(widest, diameter);
  plan.cone_box.own = o.own_bed;
  if (o.cones.empty()) {
    for (const double diameter : o.quick ? std::vector{4.0, 3.0, 5.0} : std::vector{6.0, 4.5, 8.0}) add(diameter);
    return;
  }
  const double width = std::max(o.bed_width > 0.0 ? o.bed_width / r : kConeWidths * widest / r, kLeastConeWidth);
  const double room = cone_height(widest, kConeAngle) + widest;  // m, below the base of the deepest cone
  const double depth =
      o.depths.empty() ? kConeDepth + 1.05 * room : *std::max_element(o.depths.begin(), o.depths.end());
  plan.cone_box.length = plan.cone_box.width = width, plan.cone_box.depth = depth / r;
  plan.exact_cone_depth = true;
}

}  // namespace

std::size_t SoilPlan::deepest() const {
  const auto shallower = [](const PlateBed& a, const PlateBed& b) { return a.box.depth < b.box.depth; };
  return std::max_element(plate_beds.begin(), plate_beds.end(), shallower) - plate_beds.begin();
}

PlateTest plate_test(const SoilOptions& o, double size, bool disc, double sinkage) {
  const double r = o.material.radius;
  return {.width = size / r,
          .sinkage = sinkage / r,
          .speed = o.speed,
          .samples = kMetreSamples,
          .disc = disc,
          .unload = true};
}

PlateBed plate_bed(const SoilOptions& o, const std::vector<PlateTest>& plates, double depth) {
  PlateBed bed{.plates = plates, .exact = true};
  const double r = o.material.radius;
  double length = 0.0;
  bool discs = false;
  for (const PlateTest& plate : plates) {
    length = std::max(length, (plate.disc ? kWidths : kStripWidths) * plate.width);
    discs |= plate.disc;
  }
  if (o.bed_width > 0.0) length = o.bed_width / r;
  bed.box = {length, discs ? length : kStripLength, depth / r};
  bed.box.own = o.own_bed;
  return bed;
}

SoilPlan soil_plan(const SoilOptions& o) {
  SoilPlan plan;
  if (o.quick) {
    plan.shear_box = {18.0, 8.0, 10.0};
    plan.cone_box = {20.0, 20.0, 26.0};
    plan.repose_box = {60.0, 8.0, 16.0, false, true};
    plan.repose.cut = 20.0;
  }
  plan_plates(o, plan);
  plan_cones(o, plan);
  for (Box* box : {&plan.shear_box, &plan.cone_box, &plan.repose_box}) widen(o, *box);
  for (PlateBed& bed : plan.plate_beds) widen(o, bed.box);
  const double hardest = std::min(100e3, dem::grain_modulus(o.material) / 200.0);
  const std::vector<double> chosen{0.2 * hardest, 0.5 * hardest, hardest};
  for (const double stress : o.stresses.empty() ? chosen : o.stresses) {
    ShearTest test;
    test.normal_stress = stress;
    test.speed = o.speed;
    if (o.quick) test.travel = 4.0, test.samples = 50;
    plan.shears.push_back(test);
  }
  for (const Face face : {Face::flat, Face::glued})
    for (const double stress : o.stresses.empty() ? std::vector{2e3, 5e3, 10e3, 20e3} : o.stresses) {
      ShearTest test{.normal_stress = stress, .travel = 40.0, .speed = o.speed, .face = face};
      test.friction = o.face_friction;
      if (o.quick) test.travel = 8.0, test.samples = 50;
      plan.faces.push_back(test);
    }
  return plan;
}

}  // namespace furrow::terrain::soil
