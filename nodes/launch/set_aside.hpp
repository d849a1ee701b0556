// Results that will be replaced are set aside in `.furrow-before` of their folder until the new run is under way. Runs
// in the folder with lists of their own, such as the beds of `furrow run --seeds`, are set aside with it.
//
// If this is interrupted at any point, the folder's list shows that no run came to be, and the list in `.furrow-before`
// names the files to put back. Unlisted files stay in place.
#pragma once

#include <filesystem>

#include "nodes/launch/run_list.hpp"

namespace furrow::launch {

inline constexpr const char* kAside = ".furrow-before";
inline constexpr const char* kStudy = "sweep.json";              // in the list of a study
inline constexpr const char* kCalibration = "calibration.json";  // of `furrow calibrate`

/// Checks whether the listed run, or one of several, began to step; for a calibration, whether it has a result.
bool came_to_be(const std::filesystem::path& folder);

/// Checks whether results are set aside, or something else is at their place.
bool is_set_aside(const std::filesystem::path& folder);

/// Sets aside the listed files of the folder, and begins the list again.
/// @param reads  a file that will still be read: a copy stays in place
/// @returns false if there was nothing
/// @throws Error(bad_input) if this fails; everything is as before then
bool set_aside(const std::filesystem::path& folder, const std::filesystem::path& reads = {});

/// Puts back what a killed run had set aside, unless that run came to be.
/// @throws Error(bad_input) if something else is at its place
void take_back(const std::filesystem::path& folder);

/// Removes the listed files of the folder, and those in the lists of runs in it. Errors are ignored.
void remove_results(const std::filesystem::path& folder);

/// Puts back what is set aside. Files that cannot be put back stay set aside, as the list shows. @throws Error(io)
void put_back(const std::filesystem::path& folder);

/// Removes what is set aside. @throws Error(bad_input) if its list cannot be read
void drop_aside(const std::filesystem::path& folder);

}  // namespace furrow::launch
