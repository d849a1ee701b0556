// Reads an object of a JSON file key by key: tire files, soil files, studies, soil estimates. Every error message
// contains the file, the dotted key, the offending value and the expected one. A key that is never read is an error
// that proposes the nearest valid key.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"

namespace furrow {

/// @tparam Json nlohmann::json, or nlohmann::ordered_json if the order of keys matters
template <class Json>
class BasicJsonReader {
 public:
  /// @param object outlives the reader; @param path of the object in its file: "contact", "layers[2]"
  BasicJsonReader(const Json& object, std::string file, std::string path = "");

  bool has(const std::string& key) const { return object_.contains(key); }
  /// Whether the key is present and not null.
  bool given(const std::string& key) const { return has(key) && !object_.at(key).is_null(); }

  BasicJsonReader child(const std::string& key);
  /// The object under this key; an empty one if the key is not given.
  Json object_or_empty(const std::string& key);
  const Json& array(const std::string& key);
  std::string text(const std::string& key);  // one line, which can be printed unchanged
  std::string text_or(const std::string& key, const std::string& otherwise);
  bool flag(const std::string& key);
  bool flag_or(const std::string& key, bool otherwise);
  int count(const std::string& key, int least, int most = 100000);

  double number(const std::string& key);
  double positive(const std::string& key);      // > 0
  double not_negative(const std::string& key);  // ≥ 0
  double not_negative_or(const std::string& key, double otherwise);
  /// `size` numbers (any number of them when size < 0).
  std::vector<double> numbers(const std::string& key, int size = -1);

  /// `format_version` is a whole number of at most `newest`; it may be missing unless it is required.
  void check_version(int newest, bool required = false);

  /// Marks a key as used without reading it (comments, names).
  void skip(const std::string& key);
  /// @throws Error(bad_input) when there is a key that is not one of `known`.
  void allow_only(const std::vector<std::string>& known) const;
  /// @throws Error(bad_input) when there is a key that was never read.
  void finish() const { allow_only(used_); }

  Error wrong(const std::string& key, const std::string& what) const {
    return input_error(file_, key.empty() ? path_ : full(key), what);
  }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const { throw wrong(key, what); }
  template <class First, class... More>
  [[noreturn]] void fail(const std::string& key, fmt::format_string<First, More...> what, First&& first,
                         More&&... more) const {
    throw wrong(key, fmt::format(what, std::forward<First>(first), std::forward<More>(more)...));
  }
  std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  const std::string& file() const { return file_; }
  const Json& object() const { return object_; }

 private:
  /// The value, which must have a type. @param is the member function of Json that checks it: &Json::is_string
  const Json& at(const std::string& key, bool (Json::*is)() const noexcept, const std::string& expected);

  const Json& object_;
  std::string file_, path_;
  std::vector<std::string> used_;
};

extern template class BasicJsonReader<nlohmann::json>;
extern template class BasicJsonReader<nlohmann::ordered_json>;

using JsonReader = BasicJsonReader<nlohmann::json>;
using OrderedJsonReader = BasicJsonReader<nlohmann::ordered_json>;

}  // namespace furrow
