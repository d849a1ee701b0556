#include "terrain/soil/repose.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/soil/fits.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kRestShare = 0.01;   // of √(g r): a slower rms speed counts as rest
constexpr double kSlumpShare = 0.02;  // of the square of the cut's height
constexpr int kCheckEvery = 100;      // steps
constexpr double kLow = 0.15, kHigh = 0.85;

/// Mean over y of the highest grain top in cells of 2r, for each cell along x; the base if there are no grains.
std::vector<double> profile(const dem::Grains& grains, const Specimen& s, std::vector<double>& x) {
  const double r = s.options().radius, cell = 2.0 * r;
  const int nx = static_cast<int>(s.length() / cell), ny = std::max(1, static_cast<int>(s.width() / cell));
  std::vector<double> top(static_cast<std::size_t>(nx) * ny, 0.0), height(nx, 0.0);
  for (int g = 0; g < grains.count; ++g) {
    const dem::Quad& p = grains.position[g];
    const int ix = std::clamp(static_cast<int>(p.x / cell), 0, nx - 1);
    const int iy = std::clamp(static_cast<int>((p.y + 0.5 * s.width()) / cell), 0, ny - 1);
    double& t = top[static_cast<std::size_t>(ix) * ny + iy];
    t = std::max(t, p.z + p.w);
  }
  x.resize(nx);
  for (int ix = 0; ix < nx; ++ix) {
    x[ix] = (ix + 0.5) * cell;
    for (int iy = 0; iy < ny; ++iy) height[ix] += top[static_cast<std::size_t>(ix) * ny + iy] / ny;
  }
  return height;
}

}  // namespace

double flank_angle(const std::vector<double>& x, const std::vector<double>& height, double base) {
  FURROW_ASSERT(!x.empty() && x.size() == height.size(), x.size(), height.size());
  const std::size_t tenth = std::max<std::size_t>(1, x.size() / 10);
  double crest = 0.0;
  for (std::size_t k = 0; k < tenth; ++k) crest += height[k] / static_cast<double>(tenth);
  const double low = base + kLow * (crest - base), high = base + kHigh * (crest - base);
  std::size_t first = 0;  // last point that is still high
  for (std::size_t k = 0; k < x.size(); ++k)
    if (height[k] >= high) first = k;
  std::size_t last = first;  // first point after it that is low
  while (last + 1 < x.size() && height[last] > low) ++last;
  if (last - first < 5) return last > first ? std::atan((height[first] - height[last]) / (x[last] - x[first])) : 0.0;
  const auto part = [&](const std::vector<double>& v) {
    return std::span<const double>(v).subspan(first + 1, last - first - 1);
  };
  return std::atan(-fit_line(part(x), part(height)).slope);
}

ReposeResult angle_of_repose(const Specimen& specimen, const ReposeTest& test, const WorkCall& work) {
  FURROW_ASSERT(!specimen.options().periodic_x, specimen.length());
  FURROW_ASSERT(specimen.length() > test.cut * specimen.options().radius, specimen.length(), test.cut);
  const dem::DemOptions& o = specimen.options();
  const double gravity = o.gravity.norm(), r = o.radius, dt = o.step, cut = test.cut * r, base = test.base * r;
  std::vector<dem::Quad> kept;
  for (const dem::Quad& p : specimen.positions())
    if (p.x < cut || p.z < base - r) kept.push_back(p);
  dem::GrainSolver solver(dem::solver_params(o));
  solver.set_coefficients(dem::run_coefficients(o, dt));
  solver.place(kept);

  ReposeResult result;
  result.before = profile(solver.grains(), specimen, result.x);
  result.height = specimen.height() - base;
  const double time = std::sqrt(result.height / gravity);
  const auto most = static_cast<std::int64_t>(test.longest * time / dt),
             least = static_cast<std::int64_t>(test.shortest * time / dt);
  const double mass = solver.params().grain.mass * solver.relative_mass();
  std::int64_t steps = 0;
  result.at_rest = false;
  while (steps < most && !result.at_rest) {
    work(static_cast<double>(steps) / static_cast<double>(most));
    if (const int lost = solver.step(dt); lost >= 0)
      throw physics_error("repose test: grain " + std::to_string(solver.grains().id[lost]) + " was lost");
    if (++steps % kCheckEvery != 0) continue;
    const double speed = std::sqrt(2.0 * solver.accounts().kinetic / mass);
    result.at_rest = steps > least && speed < kRestShare * std::sqrt(gravity * r);
  }
  result.time = static_cast<double>(steps) * dt;
  result.after = profile(solver.grains(), specimen, result.x);
  result.angle = flank_angle(result.x, result.after, base);
  for (std::size_t k = 0; k < result.x.size(); ++k)
    if (result.x[k] > cut + r) result.moved += 2.0 * r * std::max(0.0, result.after[k] - result.before[k]);
  result.slumped = result.moved > kSlumpShare * result.height * result.height;
  return result;
}

}  // namespace furrow::terrain::soil
