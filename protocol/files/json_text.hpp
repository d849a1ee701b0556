// Reads JSON that people wrote: takes comments (// and /* */), says where a mistake stands, and takes neither duplicate
// keys, nor numbers that no double can hold, nor nesting that would exhaust the stack of its readers, nor
// objects of so many keys that nobody wrote them.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace furrow {

/// Levels of [ ] and { } within one another that a document may have.
inline constexpr std::size_t kMaxDepth = 64;

/// @tparam Json nlohmann::json, or nlohmann::ordered_json where the order of keys matters
/// @param name of the file, for messages
/// @throws Error(bad_input): syntax and nesting with line and column; duplicate keys, keys that nobody could type or
/// that are too many, and overflowing numbers by their key
template <class Json = nlohmann::json>
Json parse_json(const std::string& text, const std::string& name);

/// The object that a file holds.
/// @param expected what should be there, for messages: "a study in JSON"
/// @throws Error(bad_input) as read_text_file and parse_json, and for what is no object
template <class Json = nlohmann::json>
Json load_json(const std::filesystem::path& file, const std::string& expected);

/// What a file of the program's own holds; null when it is missing, cut short, such as parse_json refuses, or larger
/// than a text may be.
nlohmann::ordered_json read_json_if_whole(const std::filesystem::path& file);

/// A value given on the command line: JSON if it is JSON, else a string. @throws Error(bad_input) as parse_json
nlohmann::json parse_value(const std::string& text, const std::string& name, const std::string& key);

/// A number as people write it: 200e3, 0.006, 4e-05.
std::string number_text(double value);

/// One printable line of a value, at most 60 characters, for messages.
template <class Json>
std::string value_text(const Json& value);

/// "'a', 'b' or 'c'".
std::string one_of(const nlohmann::json& values);

}  // namespace furrow
