// Where the files are that come with the program, and those that a scenario names.
#pragma once

#include <filesystem>
#include <string>

namespace furrow {

/// The folder that holds rigs/, tire/, vehicle/ and scripts/: from FURROW_HOME, or found from the program's own place.
std::filesystem::path data_folder();

/// `name` as it stands, relative to the scenario's folder, or in the data folders: rigs/ and data/ of tire/, terrain/ and
/// vehicle/.
/// @throws Error(bad_input) naming the key and where it was looked for
std::filesystem::path find_file(const std::string& name, const std::string& key,
                                const std::filesystem::path& scenario);

}  // namespace furrow
