// Reads JSON that people wrote: says where a mistake stands, and takes neither duplicate keys nor numbers
// that no double can hold.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace furrow {

/// The bytes of a text file in UTF-8.
/// @throws Error(bad_input) when it is missing, a directory, a device, empty, too large, or not UTF-8
std::string read_text_file(const std::filesystem::path& file, const std::string& expected);

/// @param name of the file, for messages
/// @throws Error(bad_input): syntax with line and column, duplicate keys and overflowing numbers by their key
nlohmann::json parse_json(const std::string& text, const std::string& name);

/// A value given on the command line: JSON if it is JSON, else a string. @throws Error(bad_input) as
/// parse_json
nlohmann::json parse_value(const std::string& text, const std::string& name, const std::string& key);

/// A number as people write it: 200e3, 0.006, 4e-05.
std::string number_text(double value);

/// One line of a value, at most 60 characters, for messages.
std::string value_text(const nlohmann::json& value);

/// "'a', 'b' or 'c'".
std::string one_of(const nlohmann::json& values);

}  // namespace furrow
