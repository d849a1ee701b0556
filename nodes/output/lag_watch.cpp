#include "nodes/output/lag_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/output/steadiness.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::output {
namespace {

constexpr double kFloor = 1e-3;       // of load × radius, the least work that passes a wheel
constexpr double kSettlement = 0.05;  // of the radius, for the bounce period that sets a window's length

}  // namespace

double lag_share(double made, double passed, double load, double radius) {
  const double least = kFloor * std::abs(load) * radius;
  const double share = std::abs(made) / std::max({passed, least, 1e-300});
  return std::isfinite(share) ? share : std::numeric_limits<double>::infinity();  // the motion is unbounded
}

double better_step(double step, double share, double bears) {
  FURROW_ASSERT(step > 0.0 && share > 0.0 && bears > 0.0, step, share, bears);
  const double most = bears < step ? std::min(bears, 0.5 * step) : step * std::clamp(kGoodShare / share, 0.1, 0.5);
  const double digit = std::pow(10.0, std::floor(std::log10(most)));
  return std::floor(most / digit * (1.0 + 1e-9)) * digit;
}

LagWatch::LagWatch(double radius, double gravity)
    : radius_(radius), length_(bounce_period(kSettlement * radius, gravity)) {
  FURROW_ASSERT(radius > 0.0, radius);
}

std::optional<LagWatch::Window> LagWatch::add(const WheelRow& now, double load, bool touches) {
  const InterfaceEnergies energies = interface_energies(now);
  if (from_ < 0.0) {
    if (touches) from_ = now.time, begin_ = energies;
    return std::nullopt;
  }
  if (now.time - from_ < length_) return std::nullopt;
  const double ground = energies.ground - begin_.ground, rim = energies.rim - begin_.rim;
  Window window;
  window.interface = std::abs(ground) >= std::abs(rim) ? "ground" : "rim";
  window.made = std::abs(ground) >= std::abs(rim) ? ground : rim;
  window.passed = energies.passed - begin_.passed;
  window.share = lag_share(window.made, window.passed, load, radius_);
  window.from = from_;
  window.to = now.time;
  from_ = now.time;
  begin_ = energies;
  return window;
}

}  // namespace furrow::output
