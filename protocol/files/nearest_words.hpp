// Guesses what a writer meant: a known name similar to an unknown one, or another unit for a value of unusual magnitude
// (Allowed::usual).
#pragma once

#include <concepts>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"

namespace furrow {

/// Number of letters to insert, remove, replace or swap with their neighbour, ignoring case.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// At most three words of `known` that look like `word`, the most similar first.
std::vector<std::string> nearest_words(const std::string& word, const std::vector<std::string>& known);

/// Text on an unknown name: "is unknown, expected 'SIMILAR'?", or a list of all known names if none is similar.
std::string unknown_text(const std::vector<std::string>& similar, const std::vector<std::string>& known);

/// "2 Pa is unusually small, usual is 5000 to 2e6 Pa: did you mean 200e3 (bar)?"; empty for a usual value and for 0.
/// @param low negative: values of both signs are usual, and none is too small
std::string unusual_text(double value, double low, double high, const std::string& unit);

/// Key and text of every unusual value of a struct and of the structs in it. If a key may be null, a negative value
/// stands for null.
template <HasFields T>
std::vector<std::pair<std::string, std::string>> unusual_values(const T& values, const std::string& path = "") {
  std::vector<std::pair<std::string, std::string>> found;
  visit_fields(values, [&]<class F, class Value>(const Value& value, const F& field) {
    if constexpr (std::derived_from<F, Key>) {
      const std::string name = path + field.name;
      if constexpr (std::is_floating_point_v<Value>) {
        if (field.usual_low == field.usual_high || (field.takes_null && value < 0.0)) return;
        if (std::string text = unusual_text(value, field.usual_low, field.usual_high, field.unit); !text.empty())
          found.emplace_back(name, std::move(text));
      } else if constexpr (HasFields<Value>) {
        for (auto& one : unusual_values(value, name + ".")) found.push_back(std::move(one));
      }
    }
  });
  return found;
}

}  // namespace furrow
