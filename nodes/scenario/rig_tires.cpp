#include "nodes/scenario/rig_tires.hpp"

#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "rigs/rigs.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

/// Applies one entry of `tires` to a wheel's tire; null changes nothing.
void change(json& tire, const json& by) {
  for (const auto& [key, value] : by.items()) tire[key] = value;
}

bool is_entry(const json& tire) { return tire.is_object() || tire.is_null(); }

}  // namespace

void fill_rig_tires(json& document, const std::string& file) {
  if (!document.contains("rig")) return;
  const std::vector<rigs::WheelTire> own = rigs::tires_of_rig(document["rig"], {file, "rig"});
  const bool one = document.contains("tire"), many = document.contains("tires");
  if (own.empty()) return;
  if (one && !is_entry(document["tire"])) return;  // the schema reports the mistake
  json tires = json::array();
  for (const rigs::WheelTire& wheel : own) tires.push_back(wheel.section);
  if (one)
    for (json& tire : tires) change(tire, document["tire"]);
  if (many) {
    const json& given = document["tires"];
    if (!given.is_array()) return;
    const std::size_t axles = static_cast<std::size_t>(own.back().axle) + 1;
    if (given.size() != own.size() && given.size() != axles)
      throw input_error(file, "tires", "has {} entries, expected {}, one per wheel, or {}, one per axle", given.size(),
                        own.size(), axles);
    for (std::size_t k = 0; k < own.size(); ++k) {
      const json& entry = given[given.size() == own.size() ? k : static_cast<std::size_t>(own[k].axle)];
      if (!is_entry(entry)) return;
      change(tires[k], entry);
    }
  }
  document.erase("tire");
  document["tires"] = tires;
}

}  // namespace furrow::scenario
