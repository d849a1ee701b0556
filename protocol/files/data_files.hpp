// Finds the files that come with the program, and those that a scenario names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace furrow {

/// The folder that contains rigs/, tire/, terrain/, vehicle/ and scripts/: from FURROW_HOME, or found from the
/// program's own location.
std::filesystem::path data_folder();

/// The file that an argument names: `name` as it is, or the file with that name in one of these folders of the data
/// folder, such as "rigs". A file in another data folder is also returned; its reader then reports its kind. A file
/// that does not exist is returned unchanged.
/// @throws Error(bad_input) if there is no such file, but one of a similar name in these folders
std::filesystem::path named_file(const std::filesystem::path& name, const std::vector<std::string>& folders);

/// `name` unchanged if absolute; otherwise relative to the scenario's folder, or in the data folders rigs/, tire/data/,
/// terrain/data/ and vehicle/data/.
/// @throws Error(bad_input) naming the key and the places that were searched
std::filesystem::path find_file(const std::string& name, const std::string& key, const std::filesystem::path& scenario);

}  // namespace furrow
