#include "tire/ring/ring_press.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "tire/ring/ring_stiffness.hpp"

namespace furrow::tire {
namespace {

constexpr double kMinLoad = 1.0;   // N, below which the residual is relative to it
constexpr double kLongest = 0.01;  // of the radius: a longer displacement is made in parts
constexpr int kMostHalvings = 6;

/// Moves the axle down to a height, in parts if one step does not find the equilibrium.
class Descent {
 public:
  Descent(RingSolver& solver, double top) : solver_(solver), height_(top + solver.ring().radius()) {}

  RingReport to(double height) {
    double step = kLongest * solver_.ring().radius();
    int halvings = 0;
    for (;;) {
      const double left = height - height_,
                   next = std::abs(left) <= step ? height : height_ + std::copysign(step, left);
      found_ = solver_.state(), closed_ = solver_.contacts().segment;
      const RingReport report = solver_.solve({0.0, next});
      if (report.converged) {
        height_ = next;
        if (next == height) return report;
      } else {
        if (report.crowded || ++halvings > kMostHalvings) return report;
        step *= 0.5;
        solver_.restart(found_, closed_);
      }
    }
  }

 private:
  RingSolver& solver_;
  double height_;
  RingField found_;
  std::vector<char> closed_;
};

void require_range(const RingMechanics& ring, const PressOptions& options) {
  const double most = kMostRingDeflection * ring.radius();
  if (options.deflection > most)
    throw input_error(options.deflection_from, options.deflection_key,
                      fmt::format("is {:g} m, expected at most {:.4g} m, a quarter of the radius: a flexible ring is "
                                  "not meant for more",
                                  options.deflection, most));
}

double lowest_radius(const RingSolver& solver) {
  double lowest = solver.ring().radius();
  for (int j = 0; j < solver.ring().segments(); ++j) {
    const GroundPoint p = solver.contact().position(solver.state(), j);
    lowest = std::min(lowest, std::hypot(p.x, p.z));
  }
  return lowest;
}

}  // namespace

std::vector<PressSample> ring_footprint(const RingSolver& solver) {
  std::vector<PressSample> samples;
  const RingMechanics& ring = solver.ring();
  const int n = ring.segments();
  const double width = ring.params().width;
  const auto place = [&](int j) { return solver.contact().position(solver.state(), (j + n) % n); };
  for (int turn = -n / 4; turn <= n / 4; ++turn) {
    const int j = (turn + n) % n;
    if (!solver.contacts().segment[j]) continue;
    const SegmentGap& gap = solver.segment_gaps()[j];
    const GroundPoint before = place(turn - 1), after = place(turn + 1);
    const double area = 0.5 * width * std::hypot(after.x - before.x, after.z - before.z);
    const double force = solver.contacts().segment_force[j] * std::hypot(gap.push_x, gap.push_z);
    samples.push_back({place(turn).x, 0.0, area, force / area});
  }
  for (std::size_t k = 0; k < solver.corner_gaps().size(); ++k) {
    if (!solver.contacts().corner[k]) continue;
    const CornerGap& gap = solver.corner_gaps()[k];
    const double area = width * ring.radius() * ring.angle();
    const double force = solver.contacts().corner_force[k] * std::hypot(gap.push_x, gap.push_z);
    samples.push_back({solver.contact().ground().corners()[gap.corner].x, 0.0, area, force / area});
  }
  std::sort(samples.begin(), samples.end(), [](const PressSample& a, const PressSample& b) { return a.x < b.x; });
  return samples;
}

PressResults press_ring(const RingParams& params, double rim_radius, const MassProperties& mass,
                        const PressOptions& options, const ProgressCall& progress) {
  const RingGround ground = plane_ground<RingGround>(options.obstacle, params.radius);
  RingSolver solver(params, ground);
  require_range(solver.ring(), options);
  require_no_camber(options, "flexible ring");
  Descent descent(solver, ground.top());
  double done = 0.0;
  PressModel model;
  model.press = [&](double deflection) {
    if (progress) progress("pressing", done);
    const RingReport report = descent.to(ground.top() + params.radius - deflection);
    if (report.crowded)
      throw input_error("command line", "--profile",
                        fmt::format("has more than {} corners under the tire at a deflection of {:.4g} m, expected a "
                                    "coarser profile",
                                    RingContact::kMostCornerGaps, deflection));
    if (!report.converged)
      throw physics_error(
          fmt::format("the ring has no equilibrium that can be found at a deflection of {:.4g} m: free force "
                      "{:.3g} N, penetration "
                      "{:.3g} m, pull {:.3g} N; see --deflection, or another number of segments",
                      deflection, report.residual, report.penetration, report.pull));
    if (const double lowest = lowest_radius(solver); lowest < rim_radius)
      throw physics_error(
          fmt::format("the ring reaches its rim at a deflection of {:.4g} m: its belt is {:.4g} m from "
                      "the axle, the rim's radius is {:.4g} m; see --deflection",
                      deflection, lowest, rim_radius));
    const RingForce force = solver.spindle_force();
    const Wrench rim{Vec3(force.x, 0.0, force.z), Vec3(0.0, solver.ring().spindle_moment(solver.state()), 0.0)};
    return PressPoint{deflection, force.z, report.residual / std::max(force.z, kMinLoad), report.steps, 0, rim};
  };
  model.footprint = [&] { return ring_footprint(solver); };
  model.stiffness = [&] {
    const Eigen::Matrix2d s = ring_ground_stiffness(solver);
    GroundStiffness all = GroundStiffness::Constant(std::nan(""));
    all(0, 0) = s(0, 0), all(0, 2) = all(2, 0) = s(0, 1), all(2, 2) = s(1, 1);
    return all;
  };
  PressResults results;
  results.stiffness_missing = kAlikeAcross;
  results.start_height = params.radius;
  results.base_missed = base_missed(options, "flexible ring");
  results.pressure = params.pressure;
  results.mass = mass;
  results.footprint_width = params.width;
  measure_press(
      options, model, [&](double share) { done = share; }, results);
  return results;
}

}  // namespace furrow::tire
