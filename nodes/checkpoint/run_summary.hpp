// Reads the results of a run for output on the terminal, sweeps and resume.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace furrow::checkpoint {

/// The summary of a run; null if the run has not ended, or the file is damaged. The keys of a single wheel are at its
/// top too; of several with a pull only `drawbar_pull_N.steady`, whether all are.
nlohmann::ordered_json read_summary(const std::filesystem::path& run);

/// The summary of a failed run: means of the available lines, and the reason under `failed`; null if it has not failed.
nlohmann::ordered_json read_failed_summary(const std::filesystem::path& run);

/// Step at which the finished run ended; negative if there is no summary.
std::int64_t finished_at(const std::filesystem::path& run);

/// Checks whether a finished run is complete although it ended before its planned end: nothing is left to do.
bool ended_early(const std::filesystem::path& run);

/// Listed results of a finished run that are missing: those that the program needs, not plots. @param frames whether
/// the run makes frames
std::vector<std::string> lost_results(const std::filesystem::path& run, bool frames);

/// summary["a"]["b"][1] for "a.b.1"; null if there is no such entry.
nlohmann::ordered_json value_at(const nlohmann::ordered_json& summary, const std::string& path);

/// The number at the path; NaN if there is none.
double number_at(const nlohmann::ordered_json& summary, const std::string& path);

}  // namespace furrow::checkpoint
