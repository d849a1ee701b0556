// Results that are to be replaced are set aside, in `.furrow-before` of their folder, until it is known that the new
// run runs. Runs in the folder with lists of their own, as the beds of `furrow run --seeds`, are set aside with it.
//
// Whenever this is cut short, the folder's list says that no run came to be, and the one in `.furrow-before` what to
// put back. What is not in a list stays where it is.
#pragma once

#include <filesystem>

#include "nodes/launch/run_list.hpp"

namespace furrow::launch {

inline constexpr const char* kAside = ".furrow-before";
inline constexpr const char* kStudy = "sweep.json";              // what the list of a study holds
inline constexpr const char* kCalibration = "calibration.json";  // of `furrow calibrate`

/// Whether the run of the folder's list began to step; of several, whether one did; whether a calibration has a result.
bool came_to_be(const std::filesystem::path& folder);

/// Whether results are set aside, or something stands in their place.
bool is_set_aside(const std::filesystem::path& folder);

/// Sets aside what the folder's list names, and begins the list again.
/// @param reads  a file that is yet to be read: a copy stays where it is
/// @returns false when there was nothing
/// @throws Error(bad_input) when it cannot be done; all is as it was then
bool set_aside(const std::filesystem::path& folder, const std::filesystem::path& reads = {});

/// What a run that was killed had set aside: put back unless that run came to be.
/// @throws Error(bad_input) when something else stands in its place
void take_back(const std::filesystem::path& folder);

/// Removes what the folder's list names, and what the lists of runs in it name. Errors are ignored.
void remove_results(const std::filesystem::path& folder);

/// Puts back what is set aside. What cannot be put back stays set aside, and the list says so. @throws Error(io)
void put_back(const std::filesystem::path& folder);

/// Removes what is set aside. @throws Error(bad_input) when its list cannot be read
void drop_aside(const std::filesystem::path& folder);

}  // namespace furrow::launch
