// Where the files are that come with the program, and those that a scenario names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace furrow {

/// The folder that holds rigs/, tire/, terrain/, vehicle/ and scripts/: from FURROW_HOME, or
/// found from the program's own place.
std::filesystem::path data_folder();

/// The file that an argument names: `name` as it is, or the file of that name in one of these folders of the data
/// folder, such as "rigs"; or in another, whose reader then says what it is. A file that does not exist is returned as
/// it is.
/// @throws Error(bad_input) where there is no such file, but one of a similar name in these folders
std::filesystem::path named_file(const std::filesystem::path& name, const std::vector<std::string>& folders);

/// `name` as it stands, relative to the scenario's folder, or in the data folders rigs/, tire/data/, terrain/data/ and
/// vehicle/data/.
/// @throws Error(bad_input) naming the key and where it was looked for
std::filesystem::path find_file(const std::string& name, const std::string& key, const std::filesystem::path& scenario);

}  // namespace furrow
