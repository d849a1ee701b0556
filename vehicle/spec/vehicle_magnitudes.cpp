#include "vehicle/spec/vehicle_magnitudes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_text.hpp"
#include "vehicle/multibody/table.hpp"
#include "vehicle/spec/part_magnitudes.hpp"
#include "vehicle/spec/shaft_speeds.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kLeastChassis = 0.05;  // of the mass of all other parts
constexpr double kMostShift = 3.0;      // s
constexpr double kMostFirst = 0.5;      // speed of the wheels over that of the engine, lowest gear
constexpr double kLeastGyration = 0.05,
                 kMostGyration = 1.5;  // radius, of the largest distance between wheels

/// Highest speed of the gearbox's input, rpm; none if there are gears between it and the engine.
std::optional<double> highest_speed(const DrivelineSpec& driveline) {
  if (!driveline.engine || !driveline.gearbox) return std::nullopt;
  const std::string &from = driveline.engine->shaft, &to = driveline.gearbox->in;
  const auto joins = [&](const auto& part) { return part && part->in == from && part->out == to; };
  if (from != to && !joins(driveline.converter) && !joins(driveline.clutch)) return std::nullopt;
  return highest_speed(*driveline.engine);
}

/// The first gear, counted from 1, whose upshift leads below the speed of the next downshift; 0: none.
std::size_t hunting_gear(const GearboxSpec& box) {
  for (std::size_t k = 0; k + 1 < box.ratios.size(); ++k)
    if (box.ratios[k + 1] > box.ratios[k] && box.up_rpm * box.ratios[k] / box.ratios[k + 1] < box.down_rpm)
      return k + 1;
  return 0;
}

/// Gears whose ratios or shift time are hardly intended; keys below `driveline`.
std::vector<std::pair<std::string, std::string>> unlikely_gears(const GearboxSpec& box) {
  std::vector<std::pair<std::string, std::string>> odd;
  if (std::adjacent_find(box.ratios.begin(), box.ratios.end(), std::greater_equal<>()) != box.ratios.end())
    odd.emplace_back("gearbox.ratios",
                     "do not rise from gear to gear, expected speed of the output over that of the input, "
                     "lowest gear first");
  if (box.shift_time > kMostShift)
    odd.emplace_back("gearbox.shift_time", fmt::format("is {} s, usual is up to {:g} s: another unit?",
                                                       number_text(box.shift_time), kMostShift));
  if (const std::size_t gear = hunting_gear(box); gear > 0)
    odd.emplace_back(
        "gearbox.down_rpm",
        fmt::format("is {}, but a change from gear {} to {} at up_rpm leaves {} rpm: it will change up and "
                    "down without end",
                    number_text(box.down_rpm), gear, gear + 1,
                    digits(box.up_rpm * box.ratios[gear - 1] / box.ratios[gear])));
  return odd;
}

/// An engine that cannot hold its idle speed, a clutch that bridges the converter; keys below `driveline`.
std::vector<std::pair<std::string, std::string>> unlikely_drives(const DrivelineSpec& line) {
  std::vector<std::pair<std::string, std::string>> odd;
  if (line.engine && line.engine->idle_rpm > 0.0) {
    const EngineSpec& engine = *line.engine;
    const double
        full = Table("engine torque", engine.torque, TableCurve::linear, TableEnd::constant).value(engine.idle_rpm),
        lost = Table("engine losses", engine.losses, TableCurve::linear, TableEnd::constant).value(engine.idle_rpm);
    if (full + lost <= 0.0)
      odd.emplace_back("engine.torque",
                       fmt::format("is {} N m at the idle speed of {} rpm, with the losses {} N m: the engine "
                                   "does not hold its idle speed",
                                   digits(full), number_text(engine.idle_rpm), digits(full + lost)));
  }
  if (line.engine && line.gearbox && line.gearbox->in == line.engine->shaft && line.gearbox->ratios.size() > 1 &&
      line.gearbox->up_rpm <= line.engine->idle_rpm)
    odd.emplace_back("gearbox.up_rpm",
                     fmt::format("is {}, and the engine idles at {} rpm: it will never stay in a lower gear",
                                 number_text(line.gearbox->up_rpm), number_text(line.engine->idle_rpm)));
  const auto& clutch = line.clutch;
  const auto& converter = line.converter;
  if (clutch && converter &&
      ((clutch->in == converter->in && clutch->out == converter->out) ||
       (clutch->in == converter->out && clutch->out == converter->in)))
    odd.emplace_back("clutch", fmt::format("lies beside the converter, between the same shafts '{}' and '{}': from "
                                           "closed_rpm, {} rpm, on it bridges the converter",
                                           clutch->in, clutch->out, number_text(clutch->closed_rpm)));
  return odd;
}

/// An axle whose wheels the engine turns opposite to the first axle's, in the lowest gear; empty if there is none.
std::string against_the_first(const DrivelineSpec& line) {
  if (!line.engine) return {};
  const std::vector<double> speeds = shaft_speeds(line, 0);
  const WheelShaftSpec* first = nullptr;
  double forward = 0.0;
  for (const WheelShaftSpec& wheel : line.wheels) {
    const int shaft = line.shaft(wheel.shaft);
    if (shaft < 0) continue;
    const double speed = speeds[static_cast<std::size_t>(shaft)];
    if (!first && speed != 0.0) first = &wheel, forward = speed;
    if (first && speed * forward < 0.0)
      return fmt::format("turn '{} {}' against '{} {}': they would fight each other", wheel.axle, wheel.side,
                         first->axle, first->side);
  }
  return {};
}

/// A first gear in which the wheels turn almost as fast as the engine; empty if there is none.
std::string too_fast(const DrivelineSpec& line) {
  if (!line.engine) return {};
  const std::vector<double> speeds = shaft_speeds(line, 0);
  double most = 0.0;
  for (const WheelShaftSpec& wheel : line.wheels)
    if (const int shaft = line.shaft(wheel.shaft); shaft >= 0)
      most = std::max(most, std::abs(speeds[static_cast<std::size_t>(shaft)]));
  if (most <= kMostFirst) return {};
  return fmt::format(
      "turn the wheels {} times as fast as the engine in the lowest gear, usual is up to {:g}: expected "
      "speed of the output over that of the input",
      digits(most), kMostFirst);
}

}  // namespace

std::optional<double> highest_speed(const EngineSpec& engine) {
  const Table torque("engine torque", engine.torque, TableCurve::linear, TableEnd::constant),
      losses("engine losses", engine.losses, TableCurve::linear, TableEnd::constant);
  std::set<double> marks;
  for (const Points* points : {&engine.torque, &engine.losses})
    for (const auto& [rpm, unused] : *points) marks.insert(rpm);
  const auto drive = [&](double rpm) { return torque.value(rpm) + losses.value(rpm); };
  if (drive(*marks.rbegin()) > 0.0) return std::nullopt;
  for (auto above = marks.rbegin(), below = std::next(above); below != marks.rend(); ++above, ++below)
    if (const double d = drive(*below), lack = drive(*above); d > 0.0)
      return *below + (*above - *below) * d / (d - lack);
  return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> unlikely_values(const VehicleSpec& spec, double mass) {
  FURROW_ASSERT(mass >= spec.chassis.mass, mass, spec.chassis.mass);
  std::vector<std::pair<std::string, std::string>> odd;
  if (const auto highest = highest_speed(spec.driveline);
      highest && spec.driveline.gearbox->ratios.size() > 1 && spec.driveline.gearbox->up_rpm >= *highest)
    odd.emplace_back("driveline.gearbox.up_rpm",
                     fmt::format("is {}, above the {:.4g} rpm to which the engine drives it: it will never "
                                 "shift up",
                                 number_text(spec.driveline.gearbox->up_rpm), *highest));
  if (spec.driveline.gearbox)
    for (auto& [key, what] : unlikely_gears(*spec.driveline.gearbox)) odd.emplace_back("driveline." + key, what);
  if (const std::string fight = against_the_first(spec.driveline); !fight.empty())
    odd.emplace_back("driveline.gears", fight);
  if (const std::string fast = too_fast(spec.driveline); !fast.empty())
    odd.emplace_back(spec.driveline.gears.empty() ? "driveline.gearbox.ratios" : "driveline.gears", fast);
  for (auto& [key, what] : unlikely_drives(spec.driveline)) odd.emplace_back("driveline." + key, what);
  for (auto& one : unlikely_parts(spec, mass)) odd.push_back(std::move(one));
  const double others = mass - spec.chassis.mass;
  if (spec.chassis.mass < kLeastChassis * others) {
    odd.emplace_back("chassis.mass", fmt::format("is {} kg, all other parts have {:.4g} kg: another unit?",
                                                 number_text(spec.chassis.mass), others));
    return odd;
  }
  const double gyration = std::sqrt(0.5 * spec.chassis.inertia.trace() / spec.chassis.mass), size = size_of(spec);
  if (gyration < kLeastGyration * size || gyration > kMostGyration * size)
    odd.emplace_back("chassis.inertia",
                     fmt::format("gives a radius of gyration of {:.3g} m between wheels that are {:.3g} m "
                                 "apart: another unit?",
                                 gyration, size));
  return odd;
}

}  // namespace furrow::vehicle
