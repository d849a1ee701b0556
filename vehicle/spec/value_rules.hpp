// Rules for the entries of lists in vehicle and driver files, each with one message.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "protocol/files/json_reader.hpp"

namespace furrow::vehicle {

// Each @throws Error(bad_input) naming file, key, value and what was expected.
void check_positive(const JsonReader& reader, const std::string& key, double value);
/// Checks that the parts of a list have different `name`s. @throws Error(bad_input) naming the second of two equal ones
template <class Part>
void check_names_once(const JsonReader& reader, const char* list, const std::vector<Part>& parts) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!names.insert(parts[i].name).second)
      reader.fail(fmt::format("{}[{}].name", list, i), "'" + parts[i].name + "' is given twice, expected another name");
}
void check_known(const JsonReader& reader, const std::string& key, const std::string& text,
                 const std::vector<std::string>& known);

}  // namespace furrow::vehicle
