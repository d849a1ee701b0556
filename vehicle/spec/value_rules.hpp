// Rules for the entries of lists in files of vehicles and drivers, each with the same words wherever it is broken.
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
/// Of the parts of a list, each with a `name`. @throws Error(bad_input) naming the second of two that are alike
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
