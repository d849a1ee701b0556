#include "nodes/scenario/scenario_checks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "nodes/scenario/estimate.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "tire/read_tire_file.hpp"
#include "tire/tire.hpp"
#include "tire/tire_magnitudes.hpp"

namespace furrow::scenario {
namespace {

constexpr double kMaxSteps = 1e10;    // beyond it the value is almost certainly a typo
constexpr double kMinGrains = 4.0;    // radii that the bin must measure at least
constexpr double kCoarseGrain = 0.1;  // of the tire radius
constexpr double kGigabyte = 1e9;
// Of τ that the step may be, without and with contact tangents: tests/studies/README.md, "Step of the flexible tire".
constexpr double kLateShare = 0.04, kTangentShare = 0.1;

class Checks {
 public:
  explicit Checks(Scenario& scenario) : s_(scenario), file_(scenario.file.string()) {}

  Error wrong(const std::string& key, const std::string& what) const { return input_error(file_, key, what); }
  void warn(const std::string& key, const std::string& what) {
    s_.warnings.push_back(wrong(key, what).what());
  }

  void times();
  void rig();
  void tires();
  void bin();
  void start(const std::vector<bool>& use_default);
  void overlaps();
  void step();
  void machine();

 private:
  /// Half of what a wheel, turned by its toe angle and leaning by its camber, takes of the bin along x and across, m.
  struct Footprint {
    double along = 0.0, across = 0.0;
  };
  Footprint footprint(std::size_t wheel) const {
    const TireSize& tire = tires_[wheel];
    const rigs::DrawbarRigOptions& rig = s_.rigs[wheel];
    const double c = std::cos(rig.toe_angle), s = std::abs(std::sin(rig.toe_angle));
    const double half =
        0.5 * tire.width * std::cos(rig.camber_angle) + tire.radius * std::abs(std::sin(rig.camber_angle));
    const double along = tire.radius * c + half * s;
    return {rig.toe_time > 0.0 ? std::max(along, tire.radius) : along, half * c + tire.radius * s};
  }
  bool grains() const { return s_.terrain.engine == "dem"; }
  /// The key of a wheel's value: the rig's own while there is no list of wheels.
  std::string wheel_key(std::size_t wheel, const std::string& name) const {
    return s_.rigs.size() == 1 ? "rig." + name : fmt::format("rig.wheels.{}.{}", wheel, name);
  }

  Scenario& s_;
  std::string file_;
  std::vector<TireSize> tires_;
};

void Checks::times() {
  const RunOptions& run = s_.run;
  if (run.end < run.step)
    throw wrong("run.end", fmt::format("is {} s, expected at least one run.step of {} s",
                                       number_text(run.end), number_text(run.step)));
  if (run.end / run.step > kMaxSteps)
    throw wrong("run.end",
                fmt::format("{} s are {:.2g} steps of {} s, expected at most {:g} steps",
                            number_text(run.end), run.end / run.step, number_text(run.step), kMaxSteps));
  if (run.average_from >= run.end)
    throw wrong("run.average_from",
                fmt::format("is {} s, expected a window that begins before the run ends at {} s",
                            number_text(run.average_from), number_text(run.end)));
  const double first_line = s_.output.series_interval;
  if (run.end - run.average_from < first_line)
    throw wrong("output.series_interval",
                fmt::format("is {} s, expected at most the averaging window of {} s", number_text(first_line),
                            number_text(run.end - run.average_from)));
  const double ramp = s_.rigs.front().ramp;
  if (ramp > run.average_from + 1e-12)
    warn("run.average_from",
         fmt::format("the window begins at {} s, while the wheel still speeds up until rig.ramp = {} s",
                     number_text(run.average_from), number_text(ramp)));
}

void Checks::rig() {
  for (std::size_t k = 0; k < s_.rigs.size(); ++k)
    if (s_.rigs[k].mode == "fixed_speed" && s_.rigs[k].slip >= 1.0)
      throw wrong(
          wheel_key(k, "slip"),
          fmt::format("is {}, expected below 1 in mode fixed_speed: a carriage that moves cannot slip fully",
                      number_text(s_.rigs[k].slip)));
  if (s_.tires.size() != s_.rigs.size())
    throw wrong("tires", fmt::format("has {} entries, expected {}: one per wheel of rig.wheels",
                                     s_.tires.size(), s_.rigs.size()));
}

void Checks::tires() {
  for (const tire::TireOptions& options : s_.tires) {
    if (options.rigid && options.contact_tangent)
      throw wrong("tire.contact_tangent", "is true, expected false for a rigid tire");
    const tire::TireFile given = tire::read_tire_file(options.file);
    tires_.push_back(tire_size(options, given));
    const tire::TireFile file = tire::tire_file_of(options, given);
    for (const auto& [key, what] : tire::unlikely_values(given))
      s_.warnings.push_back(input_error(file.path, key, what).what());
    const double share = options.contact_tangent ? kTangentShare : kLateShare, tau = file.structural_damping;
    if (!options.rigid && s_.run.step > share * tau)
      warn("run.step",
           fmt::format("{} s is more than {:g} of the tire's damping time of {} s: contact forces come one "
                       "step late and can "
                       "feed the tire; expected at most {} s{}",
                       number_text(s_.run.step), share, number_text(tau), number_text(0.5 * share * tau),
                       options.contact_tangent ? "" : ", or tire.contact_tangent"));
  }
  if (!grains()) return;
  for (std::size_t k = 0; k < tires_.size(); ++k) {
    const TireSize& tire = tires_[k];
    const double off = std::abs(s_.rigs[k].lateral);
    const Footprint foot = footprint(k);
    const double width = 2.0 * (foot.across + off + kWallMargin), length = 2.0 * (foot.along + kWallMargin);
    if (width > s_.terrain.width)
      throw wrong("terrain.width",
                  fmt::format("is {} m, expected at least {:.2f} m: the tire is {:.2f} m wide{}",
                              number_text(s_.terrain.width), width, tire.width,
                              off > 0.0 ? fmt::format(", {} m off the middle", number_text(off)) : ""));
    if (length > s_.terrain.length)
      throw wrong("terrain.length",
                  fmt::format("is {} m, expected at least {:.2f} m: the tire is {:.2f} m long",
                              number_text(s_.terrain.length), length, 2.0 * tire.radius));
    if (s_.terrain.radius > kCoarseGrain * tire.radius)
      warn("terrain.radius", fmt::format("grains of {} m are coarse under a tire of radius {} m",
                                         number_text(s_.terrain.radius), number_text(tire.radius)));
  }
}

void Checks::bin() {
  if (!grains()) return;
  const double least = kMinGrains * s_.terrain.radius;
  for (const auto& [key, size] :
       {std::pair{"terrain.length", s_.terrain.length}, {"terrain.width", s_.terrain.width}})
    if (size < least)
      throw wrong(key, fmt::format("is {} m, expected at least {} m, two grains", number_text(size),
                                   number_text(least)));
}

void Checks::start(const std::vector<bool>& use_default) {
  for (std::size_t k = 0; k < tires_.size(); ++k) {
    rigs::DrawbarRigOptions& rig = s_.rigs[k];
    const double length = s_.terrain.length, radius = footprint(k).along, reach = radius + kWallMargin;
    if (use_default[k]) {
      const AxlePath path = axle_path(s_, k, tires_[k].radius);
      const bool forward = path.to - rig.start >= 0.0;
      rig.start = !grains() ? 0.0 : forward ? reach : length - reach;
    }
    if (!grains()) continue;
    const AxlePath path = axle_path(s_, k, tires_[k].radius);
    if (path.from - radius < 0.0 || path.from + radius > length)
      throw wrong(wheel_key(k, "start"),
                  fmt::format("is {} m, expected {:.3f} to {:.3f} m: the tire of radius {} m would stand in "
                              "a wall of the bin",
                              number_text(path.from), radius, length - radius, number_text(radius)));
    if (path.to - radius < 0.0 || path.to + radius > length)
      throw wrong(
          "terrain.length",
          fmt::format("is {} m, but the axle travels from x = {:.3f} to {:.3f} m and the tire's radius "
                      "is {} m: it would hit the end wall; expected at least {:.2f} m or a shorter run",
                      number_text(length), path.from, path.to, number_text(radius),
                      std::abs(path.to - path.from) + 2.0 * reach));
  }
}

/// Wheels do not feel each other: one that stands in another would push the same grains twice.
void Checks::overlaps() {
  for (std::size_t k = 1; k < tires_.size(); ++k)
    for (std::size_t i = 0; i < k; ++i) {
      const double along = tires_[i].radius + tires_[k].radius,
                   across = 0.5 * (tires_[i].width + tires_[k].width);
      if (std::abs(s_.rigs[i].lateral - s_.rigs[k].lateral) >= across) continue;
      const double from = s_.rigs[k].start - s_.rigs[i].start;
      const double to = axle_path(s_, k, tires_[k].radius).to - axle_path(s_, i, tires_[i].radius).to;
      if (std::min(std::abs(from), std::abs(to)) >= along && from * to > 0.0) continue;
      throw wrong(
          wheel_key(k, "start"),
          fmt::format("puts this wheel in the way of wheel {}, expected {:.2f} m between their axles or "
                      "{:.2f} m between their mid-planes (lateral)",
                      i, along, across));
    }
}

void Checks::step() {
  const terrain::TerrainEstimate estimate = terrain::estimate_terrain(s_.terrain);
  if (s_.terrain.step <= estimate.stable_step) return;
  const std::string what =
      fmt::format("{} s is above the stable step of {:.3g} s ({})", number_text(s_.terrain.step),
                  estimate.stable_step, estimate.stable_reason);
  if (s_.terrain.allow_unstable_step)
    return warn("run.step", what + ", allowed by terrain.allow_unstable_step");
  throw wrong("run.step", what + ", expected a smaller step, more terrain.substeps or softer grains");
}

void Checks::machine() {
  const Estimate estimate = scenario::estimate(s_);
  const MachineState here = machine_state();
  if (here.memory_free > 0.0 && estimate.memory > here.memory_free)
    warn("", fmt::format("needs about {:.1f} GB of memory, this machine has {:.1f} GB free",
                         estimate.memory / kGigabyte, here.memory_free / kGigabyte));
  if (here.disk_free > 0.0 && estimate.disk > here.disk_free)
    warn("output.frame_interval",
         fmt::format("results need about {:.1f} GB of disk, there are {:.1f} GB free here",
                     estimate.disk / kGigabyte, here.disk_free / kGigabyte));
}

}  // namespace

void check_scenario(Scenario& scenario, const std::vector<bool>& default_start) {
  Checks checks(scenario);
  checks.times();
  checks.rig();
  checks.bin();
  checks.tires();
  checks.start(default_start);
  checks.overlaps();
  checks.step();
  checks.machine();
}

}  // namespace furrow::scenario
