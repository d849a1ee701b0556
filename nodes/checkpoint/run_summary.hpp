// What a run found, for those that come after it: results on the terminal, sweeps, resume.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace furrow::checkpoint {

/// The summary of a run; null while the run has not ended, and when the file is damaged. Of several wheels, wheel 0's
/// keys can be asked for as if it were the only one.
nlohmann::ordered_json read_summary(const std::filesystem::path& run);

/// The same of a run that has failed: means of what there is, and why under `failed`; null while it has not.
nlohmann::ordered_json read_failed_summary(const std::filesystem::path& run);

/// Step at which the finished run ended; negative while there is no summary.
std::int64_t finished_at(const std::filesystem::path& run);

/// Whether a finished run is complete although it ended before its planned end: nothing is left to be done.
bool ended_early(const std::filesystem::path& run);

/// Results of a finished run that the list of its folder names and that are gone: what the program cannot do without,
/// not plots. @param frames whether the run makes some
std::vector<std::string> lost_results(const std::filesystem::path& run, bool frames);

/// summary["a"]["b"][1] for "a.b.1"; null where there is no such entry.
nlohmann::ordered_json value_at(const nlohmann::ordered_json& summary, const std::string& path);

/// The number there; NaN where there is none.
double number_at(const nlohmann::ordered_json& summary, const std::string& path);

}  // namespace furrow::checkpoint
