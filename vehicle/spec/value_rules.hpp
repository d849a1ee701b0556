// Ranges of numbers that files of vehicles and drivers hold, each with the same words wherever it is broken.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "protocol/files/json_reader.hpp"

namespace furrow::vehicle {

// Each @throws Error(bad_input) naming file, key, value and what was expected.
void check_positive(const JsonReader& reader, const std::string& key, double value,
                    double most = std::numeric_limits<double>::infinity());
void check_not_negative(const JsonReader& reader, const std::string& key, double value,
                        double most = std::numeric_limits<double>::infinity());
void check_within(const JsonReader& reader, const std::string& key, double value, double least, double most);
void check_known(const JsonReader& reader, const std::string& key, const std::string& text,
                 const std::vector<std::string>& known);

}  // namespace furrow::vehicle
