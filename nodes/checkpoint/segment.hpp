// A run's segments, and their form in JSON, the same in checkpoints and in summary.json.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace furrow::checkpoint {

/// Largest number of steps, bytes and lines of a run: two such numbers can be added.
inline constexpr std::int64_t kMostSteps = std::int64_t{1} << 62;

/// A part of a run that was computed without interruption. Steps are those of the last part's run.step.
struct Segment {
  std::int64_t from_step = 0, to_step = 0;
  double wall_s = 0.0;
  int threads = 1;      // of the terrain
  std::string changed;  // JSON object: keys changed at its beginning, with their new values
  // Digest of the scenario until then, if this run continues after a failure with finer steps.
  std::string finer_than;
};

inline nlohmann::ordered_json segments_json(const std::vector<Segment>& segments) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Segment& s : segments) {
    list.push_back({{"from_step", s.from_step}, {"to_step", s.to_step}, {"wall_s", s.wall_s}, {"threads", s.threads}});
    if (!s.changed.empty()) list.back()["changed"] = nlohmann::ordered_json::parse(s.changed);
    if (!s.finer_than.empty()) list.back()["finer_than"] = s.finer_than;
  }
  return list;
}

/// @throws nlohmann::json::exception
inline std::vector<Segment> segments_from_json(const nlohmann::ordered_json& list) {
  std::vector<Segment> segments;
  for (const auto& j : list) {
    Segment s{j.at("from_step"), j.at("to_step"), j.at("wall_s"), j.at("threads"), "", ""};
    if (j.contains("changed")) s.changed = j.at("changed").dump();
    if (j.contains("finer_than")) s.finer_than = j.at("finer_than").get<std::string>();
    segments.push_back(s);
  }
  return segments;
}

}  // namespace furrow::checkpoint
