#include "terrain/soil/specimen.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "protocol/core/assert.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kStepShare = 0.5;    // of the stable step: teeth press single grains harder than a bed does
constexpr double kLayerHeight = 1.2;  // radii of settled bed per layer dropped

}  // namespace

double test_step(const dem::DemOptions& material) {
  return material.allow_unstable_step ? material.step : kStepShare * estimate_dem_terrain(material).stable_step;
}

Specimen::Specimen(const dem::DemOptions& material, const Box& box, std::uint64_t seed, const WorkCall& work)
    : options_(dem::level(material)) {
  FURROW_ASSERT(box.own || (box.length > 0.0 && box.width > 0.0 && box.depth > 0.0), box.length, box.width, box.depth);
  FURROW_ASSERT(material.radius > 0.0, material.radius);
  options_.activity = false;  // tools move slowly, and sheared grains must not fall asleep
  options_.seed = seed;
  options_.threads = options_.settle_threads = std::max(1, material.threads);
  if (!box.own) put_in(box);
  options_.step = test_step(options_);
  const auto made = make_dem_terrain(options_);
  made->prepare([&](const std::string& what, double share) {
    if (what == "bed not settled") settled_ = false;
    work(what == "settling the bed" ? share : 0.0);
  });
  made->save(bed_);
  const auto& x = bed_.get<double>("terrain/position");
  for (std::size_t k = 0; k + 3 < x.size(); k += 4) positions_.push_back({x[k], x[k + 1], x[k + 2], x[k + 3]});
  grains_ = made->size();
  const double half = 0.5 * options_.width;
  height_ = made->gather_mean_height(0.0, options_.length, -half, half);
  top_ = made->gather_top_height(0.0, options_.length, -half, half);
}

void Specimen::put_in(const Box& box) {
  const double r = options_.radius;
  options_.bed.clear();
  options_.tile = 0.0;
  options_.cache = false;
  options_.length = box.length * r;
  options_.width = box.width * r;
  const double widest = dem::largest_radius(options_) / r;  // grains of a layer keep the distance of the largest
  const double layer = kLayerHeight * dem::mean_volume_ratio(options_) / (widest * widest);
  options_.layers = box.layers > 0 ? box.layers : static_cast<int>(std::ceil(box.depth / layer));
  options_.periodic_x = box.periodic_x;
  options_.sides = box.periodic_y ? "periodic" : "walls";
}

std::unique_ptr<Terrain> Specimen::terrain(std::function<void()> each_substep) const {
  auto copy = make_dem_terrain(options_, std::move(each_substep));
  copy->restore(bed_);
  return copy;
}

double Specimen::weight() const {
  double cubes = 0.0;  // m³
  for (const dem::Quad& p : positions_) cubes += p.w * p.w * p.w;
  return options_.density * 4.0 / 3.0 * std::numbers::pi * cubes * options_.gravity.norm();
}

}  // namespace furrow::terrain::soil
