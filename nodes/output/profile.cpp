#include "nodes/output/profile.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

constexpr std::int64_t kMaxSteps = 4000;
constexpr std::size_t kColumns = 4;  // step, begin, exchanged, advanced

}  // namespace

std::int64_t recorded_every(std::int64_t steps) { return (steps + kMaxSteps - 1) / kMaxSteps; }

StepProfile::StepProfile(std::int64_t steps) {
  if (steps <= 0) return;
  every_ = recorded_every(steps);
  times_.reserve(kColumns * static_cast<std::size_t>(steps / every_ + 1));
}

void StepProfile::start(std::int64_t step, int part) {
  FURROW_ASSERT(in_range(part, 3), step, part);
  FURROW_ASSERT(part == 0 || !times_.empty() || every_ == 0 || step % every_ != 0, step, part);
  if (every_ == 0 || step % every_ != 0) return;
  if (part == 0) times_.insert(times_.end(), {static_cast<double>(step), 0.0, 0.0, 0.0});
  times_[times_.size() - 3 + static_cast<std::size_t>(part)] = wall_clock();
}

void write_profile(const std::filesystem::path& file, std::span<const FinalReport> reports) {
  double origin = INFINITY;
  for (const FinalReport& report : reports)
    if (report.profile.size() >= kColumns) origin = std::min(origin, report.profile[1]);
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  const auto microseconds = [&](double time) { return std::round(1e7 * (time - origin)) / 10.0; };
  for (std::size_t rank = 0; rank < reports.size(); ++rank) {
    const FinalReport& report = reports[rank];
    events.push_back(
        {{"name", "process_name"}, {"ph", "M"}, {"pid", rank}, {"args", {{"name", to_string(report.self)}}}});
    for (std::size_t i = 0; i + kColumns <= report.profile.size(); i += kColumns) {
      const double* at = &report.profile[i];
      for (int part = 0; part < 2; ++part) {
        if (!(at[2 + part] > 0.0)) continue;  // the run ended before
        events.push_back({{"name", part == 0 ? "synchronize" : "advance"},
                          {"ph", "X"},
                          {"pid", rank},
                          {"tid", 0},
                          {"ts", microseconds(at[1 + part])},
                          {"dur", std::round(1e7 * (at[2 + part] - at[1 + part])) / 10.0},
                          {"args", {{"step", static_cast<std::int64_t>(at[0])}}}});
      }
    }
  }
  write_whole_file(file, nlohmann::ordered_json{{"displayTimeUnit", "ms"}, {"traceEvents", events}}.dump() + "\n");
}

}  // namespace furrow::output
