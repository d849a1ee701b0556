#include "nodes/output/accounts_json.hpp"

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "protocol/files/json_number.hpp"

namespace furrow::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kEnergyUnit = "_J";

Json vector_json(const Vec3& v) { return {json_number(v.x()), json_number(v.y()), json_number(v.z())}; }

/// Returns a column's name without its unit.
std::string key_of(const Column& column) {
  std::string_view name = column.name;
  if (name.ends_with(kEnergyUnit)) name.remove_suffix(kEnergyUnit.size());
  return std::string(name);
}

template <HasFields S>
Json entries_json(const S& entries) {
  Json json;
  visit_fields(entries, [&](const double& value, const Column& column) { json[key_of(column)] = json_number(value); });
  return json;
}

/// Two sides of one interface, the impulse under way between them, and their remaining difference.
Json sides_json(const char* one, const Vec3& a, const char* other, const Vec3& b, const Vec3& under_way,
                const Vec3& difference) {
  return {{one, vector_json(a)},
          {other, vector_json(b)},
          {"under_way", vector_json(under_way)},
          {"difference", vector_json(difference)}};
}

Json momentum_json(const Accounts& accounts) {
  const MomentumAccount m = accounts.momentum();
  Json tires = Json::array();
  for (std::size_t k = 0; k < accounts.now().tires.size(); ++k) {
    const TireAccount &start = accounts.start().tires[k], &now = accounts.now().tires[k];
    tires.push_back({{"momentum", vector_json(now.model.momentum - start.model.momentum)},
                     {"gravity", vector_json(now.gravity_impulse - start.gravity_impulse)},
                     {"terrain", vector_json(now.terrain_impulse - start.terrain_impulse)},
                     {"on_the_rim", vector_json(now.spindle_impulse - start.spindle_impulse)},
                     {"of_it_left_by_the_solver", vector_json(now.model.solver_impulse - start.model.solver_impulse)}});
  }
  return {{"unit", "N s"},
          {"grains", vector_json(m.grains)},
          {"tires", vector_json(m.tires)},
          {"carrier", vector_json(m.carrier)},
          {"under_way", vector_json(m.under_way)},
          {"gravity", vector_json(m.terrain_gravity + m.tire_gravity + m.carrier_gravity)},
          {"walls", vector_json(m.walls)},
          {"guide", vector_json(m.guide)},
          {"sleep", vector_json(m.sleep)},
          {"residual", vector_json(m.residual())},
          {"largest", json_number(m.largest())},
          {"residual_share", json_number(m.largest() > 0.0 ? m.residual().norm() / m.largest() : 0.0)},
          {"closes", m.closes()},
          {"surface", sides_json("grains", m.surface_of_grains, "tires", m.surface_of_tires, m.surface_under_way,
                                 m.surface_difference())},
          {"spindle", sides_json("tires", m.spindle_of_tires, "carrier", m.spindle_of_carrier, m.spindle_under_way,
                                 m.spindle_difference())},
          {"each_tire", tires}};
}

Json tires_json(const Accounts& accounts) {
  Json tires = Json::array();
  for (std::size_t k = 0; k < accounts.now().tires.size(); ++k) {
    const TireAccount &start = accounts.start().tires[k], &now = accounts.now().tires[k];
    const TireDiagnostics &from = start.model, &to = now.model;
    tires.push_back({{"rim_work", json_number(now.rim_work - start.rim_work)},
                     {"terrain_work", json_number(now.terrain_work - start.terrain_work)},
                     {"kinetic", json_number(to.kinetic_energy - from.kinetic_energy)},
                     {"elastic", json_number(to.elastic_energy - from.elastic_energy)},
                     {"pressure", json_number(to.pressure_energy - from.pressure_energy)},
                     {"potential", json_number(to.potential_energy - from.potential_energy)},
                     {"viscous_loss", json_number(to.dissipation - from.dissipation)},
                     {"numerical_loss", json_number(to.numerical_loss - from.numerical_loss)},
                     {"solver_loss", json_number(to.solver_loss - from.solver_loss)},
                     {"residual", json_number(tire_residual(start, now))}});
  }
  return tires;
}

/// Returns mean powers between the last line before `from` and the last line.
Json powers_json(const Table& table, double from) {
  const std::vector<double> times = table.column("time_s");
  std::size_t first = 0;
  while (first + 1 < times.size() && times[first + 1] < from) ++first;
  if (first + 1 >= times.size()) return nullptr;
  const double duration = times.back() - times[first];
  Json json = {{"unit", "W"}, {"from_s", times[first]}, {"to_s", times.back()}};
  for (const Column& column : table.columns) {
    if (!std::string_view(column.name).ends_with(kEnergyUnit)) continue;
    const std::vector<double> values = table.column(column.name);
    json[key_of(column)] = json_number((values.back() - values[first]) / duration);
  }
  return json;
}

}  // namespace

Json accounts_json(const Accounts& accounts, const Table& table, double from) {
  const EnergyAccount e = accounts.energy();
  const double turnover = e.turnover(), residual = e.residual();
  Json energy = {{"unit", "J"},
                 {"work", entries_json(e.work)},
                 {"stored", entries_json(e.stored)},
                 {"lost", entries_json(e.lost)},
                 {"residual", json_number(residual)},
                 {"residual_of",
                  {{"terrain", json_number(e.terrain_residual)},
                   {"tires", json_number(e.tire_residual)},
                   {"rig", json_number(e.rig_residual)}}},
                 {"turnover", json_number(turnover)},
                 {"residual_share", json_number(turnover > 0.0 ? residual / turnover : 0.0)},
                 {"sample_error", json_number(e.sample_error)},
                 {"bound", json_number(e.bound())},
                 {"closes", e.closes()},
                 {"each_tire", tires_json(accounts)},
                 {"power", powers_json(table, from)}};
  return {{"from_s", accounts.start().time},
          {"to_s", accounts.now().time},
          {"momentum", momentum_json(accounts)},
          {"energy", energy}};
}

}  // namespace furrow::output
