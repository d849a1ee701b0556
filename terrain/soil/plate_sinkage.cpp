#include "terrain/soil/plate_sinkage.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kSides = 4.0;  // height of the plate's sides beyond the sinkage, radii

}  // namespace

PlateResult plate_sinkage(const Specimen& specimen, const PlateTest& test, const WorkCall& work) {
  FURROW_ASSERT(test.samples > 0 && test.speed > 0.0, test.samples, test.speed);
  const double r = specimen.options().radius, half = 0.5 * specimen.width();
  const double width = test.width * r, middle = 0.5 * specimen.length();
  double share = 0.0;
  const auto terrain = specimen.terrain([&] { work(share); });
  const double from = terrain->gather_top_height(middle - 0.5 * width, middle + 0.5 * width, -half, half);
  const double surface = specimen.height(), to = surface - test.sinkage * r;
  Tool plate = strip_plate(middle, width, half, from, (test.sinkage + kSides) * r);
  terrain->attach(plate.mesh(), rough_material(specimen.options()), plate.state());
  plate.set_velocity(Vec3(0.0, 0.0, -test.speed));

  const double interval = (from - to) / test.speed / test.samples;
  const int steps = std::max(1, static_cast<int>(std::ceil(interval / specimen.step())));
  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  PlateResult result;
  result.curve.width = width;
  double off = 0.0;
  for (int k = 0; k < test.samples; ++k) {
    const Outcome outcome = terrain->advance({&plate.state(), 1}, interval, steps, forces, sums);
    if (!outcome.ok) throw physics_error(outcome, "plate sinkage test: terrain");
    plate.moved(interval);
    share = static_cast<double>(k + 1) / test.samples;
    const double force = sums[0].force.z();
    // The force is the mean over the interval and belongs to its middle.
    result.curve.sinkage.push_back(surface - from + (k + 0.5) * interval * test.speed);
    result.curve.pressure.push_back(force / (width * 2.0 * half));
    if (2 * k >= test.samples) off += (terrain->gather_state().floor_force - specimen.weight() - force) / force;
  }
  result.balance_error = std::abs(off) / (0.5 * test.samples);
  return result;
}

}  // namespace furrow::terrain::soil
