#include "vehicle/spec/value_rules.hpp"

#include <algorithm>

#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::vehicle {

void check_positive(const JsonReader& reader, const std::string& key, double value) {
  if (!(value > 0.0)) reader.fail(key, "is " + number_text(value) + ", expected a number above zero");
}

void check_known(const JsonReader& reader, const std::string& key, const std::string& text,
                 const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), text) == known.end())
    reader.fail(key, "'" + text + "' " + unknown_text(nearest_words(text, known), known));
}

}  // namespace furrow::vehicle
