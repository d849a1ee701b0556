#include "terrain/soil/cone.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/soil/fits.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kLeastReach = 0.5;  // diameters by which the base must go below the surface

}  // namespace

ConeResult cone_penetration(const Specimen& specimen, const ConeTest& test, const WorkCall& work) {
  FURROW_ASSERT(test.samples > 0 && test.speed > 0.0 && test.diameter > 0.0, test.samples, test.speed, test.diameter);
  const double r = specimen.options().radius, diameter = test.diameter * r;
  const double middle = 0.5 * specimen.length(), reach = 0.5 * diameter;
  double share = 0.0;
  const auto terrain = specimen.terrain([&] { work(share); });
  const double top = terrain->gather_top_height(middle - reach, middle + reach, -reach, reach);
  const double cone = cone_height(diameter, kConeAngle), surface = specimen.height();
  const double deepest = std::min(test.depth * r, surface - cone - diameter);
  if (deepest < kLeastReach * diameter)
    throw Error(ExitCode::bad_input,
                fmt::format("cone penetration test: the bed is {:.3g} m deep, expected at least {:.3g} m for a cone of "
                            "{:.3g} m",
                            surface, cone + (1.0 + kLeastReach) * diameter, diameter));
  const double path = top - surface + cone + deepest;
  Tool tool = cone_on_shaft(Vec3(middle, 0.0, top), diameter, kConeAngle, kConeShaft, deepest + 4.0 * r);
  terrain->attach(tool.mesh(), smooth_material(specimen.options()), tool.state());
  tool.set_velocity(Vec3(0.0, 0.0, -test.speed));

  const double interval = path / test.speed / test.samples, area = cone_base_area(diameter);
  const int steps = std::max(1, static_cast<int>(std::ceil(interval / specimen.step())));
  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  ConeResult result;
  int counted = 0;
  for (int k = 0; k < test.samples; ++k) {
    const Outcome outcome = terrain->advance({&tool.state(), 1}, interval, steps, forces, sums);
    if (!outcome.ok) throw physics_error(outcome, "cone penetration test: terrain");
    tool.moved(interval);
    share = static_cast<double>(k + 1) / test.samples;
    const double depth = (k + 0.5) * interval * test.speed - (top - surface) - cone;
    result.depth.push_back(depth);
    result.pressure.push_back(sums[0].force.z() / area);
    if (depth < test.index_from * r || depth > test.index_to * r) continue;
    result.index += result.pressure.back();
    ++counted;
  }
  result.index /= std::max(counted, 1);
  const auto in = std::find_if(result.depth.begin(), result.depth.end(), [](double depth) { return depth >= 0.0; });
  const auto first = static_cast<std::size_t>(in - result.depth.begin());
  const std::span<const double> depth = std::span(result.depth).subspan(first),
                                pressure = std::span(result.pressure).subspan(first);
  if (depth.size() < 2) return result;
  result.reached = deepest;
  result.mean = mean_of(pressure).value;
  result.gradient = fit_line(depth, pressure).slope;
  return result;
}

}  // namespace furrow::terrain::soil
