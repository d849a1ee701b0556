#include "tire/planar/planar_press.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::tire {
namespace {

constexpr double kMinLoad = 1.0;  // N, below which the residual is relative to it

void require_range(const PlanarParams& params, const PressOptions& options) {
  const double most = kMostPlanarDeflection * (params.size.radius - params.size.rim_radius);
  if (options.deflection > most)
    throw input_error(options.deflection_from, options.deflection_key,
                      fmt::format("is {:g} m, expected at most {:.4g} m, {:g} of the tire's height over its rim: its "
                                  "triangles turn inside out beyond",
                                  options.deflection, most, kMostPlanarDeflection));
}

}  // namespace

std::vector<PressSample> planar_footprint(const PlanarStatic& wheel) {
  const std::vector<int>& outer = wheel.mesh().outer;
  const PlanarField& x = wheel.shape();
  const int n = static_cast<int>(outer.size());
  std::vector<int> place(x.size(), 0);
  for (int j = 0; j < n; ++j) place[outer[j]] = j;
  const auto length = [&](int j) {  // of the side from the outer node j on
    const int a = outer[(j + n) % n], b = outer[(j + 1) % n];
    return std::hypot(x.x[b] - x.x[a], x.z[b] - x.z[a]);
  };
  std::vector<PressSample> samples;
  for (const PlanarTouch& t : wheel.contact().touches()) {
    const int j = place[t.a], b = t.b < 0 ? t.a : t.b;
    const double side = t.b < 0 ? 0.5 * (length(j - 1) + length(j)) : length(j);
    const double area = side * wheel.elements().options().width;
    samples.push_back({(1.0 - t.share) * x.x[t.a] + t.share * x.x[b], 0.0, area, t.force / area});
  }
  std::sort(samples.begin(), samples.end(), [](const PressSample& a, const PressSample& b) { return a.x < b.x; });
  return samples;
}

PressResults press_planar(const PlanarParams& params, const MassProperties& mass, const PressOptions& options,
                          const ProgressCall& progress) {
  require_range(params, options);
  require_no_camber(options, "planar tire");
  PlanarStatic wheel(params, plane_ground<PlanarGround>(options.obstacle, params.size.radius));
  const double top = wheel.contact().ground().top();
  double done = 0.0;
  PressModel model;
  model.press = [&](double deflection) {
    if (progress) progress("pressing", done);
    const PlanarReport report = wheel.move_to({0.0, top + params.size.radius - deflection});
    if (!report.converged)
      throw physics_error(
          fmt::format("the planar tire has no equilibrium that can be found at a deflection of {:.4g} m: free force "
                      "{:.3g} N; see --deflection, or another mesh",
                      deflection, report.residual));
    const double force = wheel.force();
    return PressPoint{deflection,        force,      report.residual / std::max(force, kMinLoad), report.steps,
                      report.indefinite, wheel.rim()};
  };
  model.footprint = [&] { return planar_footprint(wheel); };
  PressResults results;
  model.stiffness = [&] {
    const GroundStiffness s = wheel.ground_stiffness();
    results.stiffness_missing =
        std::isfinite(s(2, 2)) ? kAlikeAcross : "the tangent is not positive definite at this load";
    return s;
  };
  results.start_height = params.size.radius;
  results.base_missed = base_missed(options, "planar tire");
  results.mass = mass;
  results.footprint_width = params.options.width;
  measure_press(
      options, model, [&](double share) { done = share; }, results);
  return results;
}

}  // namespace furrow::tire
