// Rules for engines, gears and shafts, one by one and together.
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "protocol/files/json_text.hpp"
#include "vehicle/spec/spec_rules.hpp"
#include "vehicle/spec/suspension_abilities.hpp"
#include "vehicle/spec/value_rules.hpp"

namespace furrow::vehicle {
void check_spec(const ShaftSpec& s, const JsonReader& reader) {
  if (!(s.axis.norm() > 0.0)) reader.fail("axis", "has no length, expected a direction");
}

void check_spec(const EngineSpec& s, const JsonReader& reader) {
  if (const double last = s.torque.back().first; s.idle_rpm > last)
    reader.fail("idle_rpm", fmt::format("is {}, expected at most {}, the last speed of torque", number_text(s.idle_rpm),
                                        number_text(last)));
  for (std::size_t i = 0; i < s.losses.size(); ++i)
    if (s.losses[i].first * s.losses[i].second > 0.0)
      reader.fail(fmt::format("losses[{}]", i),
                  fmt::format("drives the engine with {} N m, expected a torque against its speed",
                              number_text(s.losses[i].second)));
}

void check_spec(const ConverterSpec& s, const JsonReader& reader) {
  for (const auto& [key, points] : {std::pair{"capacity", &s.capacity}, std::pair{"torque_ratio", &s.torque_ratio}}) {
    if (points->front().first != 0.0 || points->back().first != 1.0)
      reader.fail(key, "does not run from speed ratio 0 to 1, expected both ends");
    for (std::size_t i = 0; i < points->size(); ++i)
      check_positive(reader, fmt::format("{}[{}]", key, i), (*points)[i].second);
  }
  for (std::size_t i = 0; i < s.torque_ratio.size(); ++i)
    if (const auto& [R, T] = s.torque_ratio[i]; R * T > 1.0)
      reader.fail(fmt::format("torque_ratio[{}]", i),
                  fmt::format("gives {} times the power that it takes, expected at most 1", number_text(R * T)));
}

void check_spec(const ClutchSpec& s, const JsonReader& reader) {
  if (!(s.closed_rpm > s.open_rpm))
    reader.fail("closed_rpm", fmt::format("is {}, expected more than open_rpm, {}", number_text(s.closed_rpm),
                                          number_text(s.open_rpm)));
}

void check_spec(const GearboxSpec& s, const JsonReader& reader) {
  if (s.ratios.empty()) reader.fail("ratios", "is empty, expected the ratio of at least one gear");
  for (std::size_t i = 0; i < s.ratios.size(); ++i) check_positive(reader, fmt::format("ratios[{}]", i), s.ratios[i]);
  if (!(s.up_rpm > s.down_rpm))
    reader.fail("up_rpm",
                fmt::format("is {}, expected more than down_rpm, {}", number_text(s.up_rpm), number_text(s.down_rpm)));
}

void check_spec(const GearSpec& s, const JsonReader& reader) {
  if (s.ratio == 0.0) reader.fail("ratio", "is 0, expected another number: output over input");
  if (s.in == s.out) reader.fail("out", "is '" + s.out + "', the shaft of in, expected another one");
}

void check_spec(const DifferentialSpec& s, const JsonReader& reader) {
  if (s.outputs.size() != 2) reader.fail("outputs", fmt::format("has {} shafts, expected two", s.outputs.size()));
  if (s.outputs[0] == s.outputs[1] || s.outputs[0] == s.box || s.outputs[1] == s.box)
    reader.fail("outputs", "names a shaft twice, expected two shafts besides the box");
}

void check_spec(const MotorSpec& s, const JsonReader& reader) {
  if (s.gear_ratio == 0.0) reader.fail("gear_ratio", "is 0, expected another number: motor over wheel");
}

void check_spec(const DrivelineSpec& s, const JsonReader& reader) {
  if (s.skid_steer != 0.0 && s.motors.empty())
    reader.fail("skid_steer", "is given without motors, expected a motor at each wheel");
  for (const bool gearbox : {false, true})
    if ((gearbox ? s.gearbox.has_value() : s.clutch.has_value() || s.converter.has_value()) && !s.engine)
      reader.fail("engine", fmt::format("is missing, expected an engine for the {}", gearbox ? "gearbox" : "clutch"));
}

namespace {

/// Named shafts, the parts that join them, and the rows in speeds that join them without slip.
class ShaftGraph {
 public:
  ShaftGraph(const VehicleSpec& vehicle, const JsonReader& reader)
      : vehicle_(vehicle), spec_(vehicle.driveline), reader_(reader) {}

  void check() {
    name_shafts();
    check_names_once(reader_, "gears", spec_.gears);
    check_names_once(reader_, "differentials", spec_.differentials);
    join_all();
    check_wheels();
    check_outputs();
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (!reaches_wheel_.contains(root(static_cast<int>(i))))
        reader_.fail(fmt::format("shafts[{}].name", i),
                     fmt::format("'{}' reaches no wheel, expected a train of gears to one", names_[i]));
  }

 private:
  void name_shafts() {
    check_names_once(reader_, "shafts", spec_.shafts);
    for (std::size_t i = 0; i < spec_.shafts.size(); ++i) {
      const ShaftSpec& shaft = spec_.shafts[i];
      names_.push_back(shaft.name);
      const int axle = vehicle_.axle(shaft.carrier);
      const bool housing = axle >= 0 && can(kHasHousing, vehicle_.axles[axle].corners[kLeft].suspension);
      if (shaft.carrier != "chassis" && !housing)
        reader_.fail(fmt::format("shafts[{}].carrier", i),
                     "is '" + shaft.carrier + "', expected 'chassis' or the name of a rigid axle");
    }
    parent_.resize(names_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int shaft(const std::string& key, const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end())
      reader_.fail(key, names_.empty() ? "is '" + name + "', but there are no shafts, expected one in shafts"
                                       : "is '" + name + "', expected one of the shafts " + one_of(names_));
    return static_cast<int>(found - names_.begin());
  }
  int root(int k) const {
    while (parent_[k] != k) k = parent_[k];
    return k;
  }
  void join(int a, int b) { parent_[root(a)] = root(b); }

  /// Adds a row in speeds; false if it follows from earlier rows.
  bool independent(std::vector<std::pair<int, double>> terms) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(static_cast<int>(names_.size()));
    for (const auto& [index, factor] : terms) row[index] += factor;
    row.normalize();
    for (const Eigen::VectorXd& other : rows_) row -= other.dot(row) * other;
    for (const Eigen::VectorXd& other : rows_) row -= other.dot(row) * other;
    if (!(row.norm() > 1e-9)) return false;
    rows_.push_back(row.normalized());
    return true;
  }

  void join_all() {
    if (spec_.engine) shaft("engine.shaft", spec_.engine->shaft);
    if (spec_.converter) pair("converter", spec_.converter->in, spec_.converter->out);
    if (spec_.clutch) pair("clutch", spec_.clutch->in, spec_.clutch->out);
    if (spec_.gearbox) {
      const auto [in, out] = pair("gearbox", spec_.gearbox->in, spec_.gearbox->out);
      independent({{out, 1.0}, {in, -spec_.gearbox->ratios.front()}});
    }
    for (std::size_t i = 0; i < spec_.gears.size(); ++i) join_gear(spec_.gears[i], fmt::format("gears[{}]", i));
    for (std::size_t i = 0; i < spec_.differentials.size(); ++i)
      join_differential(spec_.differentials[i], fmt::format("differentials[{}]", i));
  }

  /// Two shafts of one carrier by default.
  std::pair<int, int> pair(const std::string& part, const std::string& in, const std::string& out,
                           bool same_carrier = true) {
    if (in == out) reader_.fail(part + ".out", "is '" + out + "', the shaft of in, expected another one");
    const int a = shaft(part + ".in", in), b = shaft(part + ".out", out);
    if (same_carrier) check_carrier(part + ".out", a, b);
    join(a, b);
    return {a, b};
  }

  void check_carrier(const std::string& key, int a, int b) const {
    if (spec_.shafts[a].carrier != spec_.shafts[b].carrier)
      reader_.fail(key, fmt::format("'{}' turns in '{}', expected a shaft in '{}'", names_[b], spec_.shafts[b].carrier,
                                    spec_.shafts[a].carrier));
  }

  void join_gear(const GearSpec& gear, const std::string& key) {
    const auto [in, out] = pair(key, gear.in, gear.out, false);
    if (spec_.shafts[in].carrier != spec_.shafts[out].carrier && gear.ratio != 1.0)
      reader_.fail(key + ".ratio",
                   fmt::format("is {} between shafts in '{}' and '{}', expected 1: gears turn in one housing",
                               number_text(gear.ratio), spec_.shafts[in].carrier, spec_.shafts[out].carrier));
    if (!independent({{out, 1.0}, {in, -gear.ratio}}))
      reader_.fail(key, "'" + gear.name + "' closes a loop of gears, expected a train without loops");
  }

  void join_differential(const DifferentialSpec& d, const std::string& key) {
    const int box = shaft(key + ".box", d.box);
    const int first = shaft(key + ".outputs", d.outputs[0]), second = shaft(key + ".outputs", d.outputs[1]);
    for (const int output : {first, second}) {
      check_carrier(key + ".outputs", box, output);
      join(box, output);
    }
    if (!independent({{first, d.share}, {second, 1.0 - d.share}, {box, -1.0}}))
      reader_.fail(key, "'" + d.name + "' closes a loop of gears, expected a train without loops");
  }

  /// Refuses an output that is not joined: it runs free, so the other output gets no torque.
  void check_outputs() const {
    std::multiset<std::string> used;
    const auto use = [&](const auto& part) { used.insert(part.in), used.insert(part.out); };
    if (spec_.engine) used.insert(spec_.engine->shaft);
    if (spec_.converter) use(*spec_.converter);
    if (spec_.clutch) use(*spec_.clutch);
    if (spec_.gearbox) use(*spec_.gearbox);
    for (const GearSpec& gear : spec_.gears) use(gear);
    for (const WheelShaftSpec& wheel : spec_.wheels) used.insert(wheel.shaft);
    for (const DifferentialSpec& d : spec_.differentials) {
      used.insert(d.box);
      used.insert(d.outputs.begin(), d.outputs.end());
    }
    for (std::size_t i = 0; i < spec_.differentials.size(); ++i)
      for (const std::string& output : spec_.differentials[i].outputs)
        if (used.count(output) == 1)
          reader_.fail(
              fmt::format("differentials[{}].outputs", i),
              "'" + output + "' drives nothing, expected a shaft that a wheel, a gear or a differential takes on");
  }

  void check_wheels() {
    std::set<std::pair<int, int>> wheels;
    std::set<int> used;
    const auto axle = [&](const std::string& key, const std::string& name) {
      std::vector<std::string> names;
      for (const AxleSpec& one : vehicle_.axles) names.push_back(one.name);
      if (vehicle_.axle(name) < 0) reader_.fail(key, "is '" + name + "', expected one of the axles " + one_of(names));
      return vehicle_.axle(name);
    };
    for (std::size_t i = 0; i < spec_.wheels.size(); ++i) {
      const WheelShaftSpec& wheel = spec_.wheels[i];
      const std::string key = fmt::format("wheels[{}]", i);
      const int index = shaft(key + ".shaft", wheel.shaft), k = axle(key + ".axle", wheel.axle);
      if (wheel.side != "left" && wheel.side != "right")
        reader_.fail(key + ".side", "is '" + wheel.side + "', expected 'left' or 'right'");
      if (!wheels.insert({k, wheel.side == "left" ? kLeft : kRight}).second)
        reader_.fail(
            key, fmt::format("drives the wheel '{} {}' again, expected one shaft per wheel", wheel.axle, wheel.side));
      if (!used.insert(index).second)
        reader_.fail(key + ".shaft", "'" + wheel.shaft + "' drives two wheels, expected a shaft for each");
      reaches_wheel_.insert(root(index));
    }
    for (std::size_t i = 0; i < spec_.motors.size(); ++i) {
      const std::string key = fmt::format("motors[{}].axle", i);
      const int k = axle(key, spec_.motors[i].axle);
      for (const int side : {kLeft, kRight})
        if (!wheels.insert({k, side}).second)
          reader_.fail(key, "'" + spec_.motors[i].axle + "' is driven already, expected one drive per wheel");
    }
  }

  const VehicleSpec& vehicle_;
  const DrivelineSpec& spec_;
  const JsonReader& reader_;
  std::vector<std::string> names_;
  std::vector<int> parent_;
  std::set<int> reaches_wheel_;
  std::vector<Eigen::VectorXd> rows_;
};

}  // namespace

void check_driveline(const VehicleSpec& vehicle, const JsonReader& driveline) {
  ShaftGraph(vehicle, driveline).check();
}

}  // namespace furrow::vehicle
