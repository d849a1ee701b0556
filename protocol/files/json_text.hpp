// Reads JSON that people wrote. It accepts comments (// and /* */) and reports where a mistake is. It refuses duplicate
// keys, numbers that do not fit a double, nesting that would exhaust the stack of its readers, and objects with more
// keys than anybody writes.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace furrow {

/// Most levels of nested [ ] and { } in a document.
inline constexpr std::size_t kMaxDepth = 64;

/// @tparam Json nlohmann::json, or nlohmann::ordered_json if the order of keys matters
/// @param name of the file, for messages
/// @throws Error(bad_input): syntax and nesting with line and column; duplicate keys, keys that nobody could type, too
/// many keys, and overflowing numbers with their key
template <class Json = nlohmann::json>
Json parse_json(const std::string& text, const std::string& name);

/// The object in a file.
/// @param expected what should be there, for messages: "a study in JSON"
/// @throws Error(bad_input) as read_text_file and parse_json, and if the document is not an object
template <class Json = nlohmann::json>
Json load_json(const std::filesystem::path& file, const std::string& expected);

/// The contents of a file that the program wrote; null if it is missing, cut short, refused by parse_json, or larger
/// than a text may be.
nlohmann::ordered_json read_json_if_whole(const std::filesystem::path& file);

/// A value from the command line: JSON if it is valid JSON, else a string. @throws Error(bad_input) as parse_json
nlohmann::json parse_value(const std::string& text, const std::string& name, const std::string& key);

/// A number as people write it: 200e3, 0.006, 4e-05.
std::string number_text(double value);

/// One printable line of a value, at most 60 characters, for messages.
template <class Json>
std::string value_text(const Json& value);

/// "'a', 'b' or 'c'".
std::string one_of(const nlohmann::json& values);

}  // namespace furrow
