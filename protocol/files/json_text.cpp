#include "protocol/files/json_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxKey = 256;  // bytes of a key
// Of an object: the time to find one among ordered keys is proportional to their number.
constexpr std::size_t kMaxKeys = 10000;

/// The byte after the comment that begins at `at`; `at` if none begins there.
std::size_t after_comment(const std::string& text, std::size_t at) {
  if (text.compare(at, 2, "//") == 0) return std::min(text.find_first_of("\n\r", at), text.size());
  if (text.compare(at, 2, "/*") != 0) return at;
  const std::size_t end = text.find("*/", at + 2);
  return end == std::string::npos ? text.size() : end + 2;
}

/// Offset of the bracket that opens level kMaxDepth + 1, or npos. Brackets within texts and comments do not count.
std::size_t find_too_deep(const std::string& text) {
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!quoted)
      if (const std::size_t after = after_comment(text, at); after != at) {
        at = after - 1;
        continue;
      }
    const char c = text[at];
    if (quoted)
      at += c == '\\';  // an escaped character does not end the text
    else if (c == '[' || c == '{')
      ++depth;
    else if ((c == ']' || c == '}') && depth > 0)
      --depth;
    if (c == '"') quoted = !quoted;
    if (depth > kMaxDepth) return at;
  }
  return std::string::npos;
}

std::string too_deep() {
  return fmt::format("lists and objects are nested deeper than {} levels, expected fewer", kMaxDepth);
}

/// Explains a likely slip from another notation, at the byte where parsing failed; empty if it looks like none of them.
std::string likely_slip(const std::string& text, std::size_t at) {
  if (at >= text.size()) return {};
  if (text[at] == '\'') return "a text is in double quotes";
  const auto digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
  if (text[at] == '}' || text[at] == ']') {
    const std::size_t before = text.find_last_not_of(" \t\r\n", at == 0 ? 0 : at - 1);
    return before != std::string::npos && before < at && text[before] == ','
               ? "a comma stands between entries, none after the last"
               : "";
  }
  // Last byte before the number that ends there; npos if the number is at the beginning.
  const std::size_t comma = text.find_last_not_of("0123456789.eE+-", at);
  if (digit(at) && comma != std::string::npos && text[comma] == ',' && comma > 0 && digit(comma - 1))
    return "a number has a decimal point, no comma";
  return {};
}

/// Refuses meshes of wheels, which some users give as a tire. @throws Error(bad_input)
void refuse_meshes(const std::filesystem::path& file, const std::string& expected) {
  std::string end = file.extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  if (end == ".obj" || end == ".stl" || end == ".ply")
    throw input_error(file.string(), "",
                      "is a mesh, expected {}: meshes are not read; a rigid wheel is described by its profile, as in "
                      "tire/data/rigid_drum.json",
                      expected);
}

/// Builds a document event by event, so that keys can be checked when they arrive.
template <class Json>
class Builder final : public nlohmann::json_sax<Json> {
  using Base = nlohmann::json_sax<Json>;

 public:
  Builder(const std::string& text, std::string name) : text_(text), name_(std::move(name)) {}

  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(typename Base::number_integer_t value) override { return add(value); }
  bool number_unsigned(typename Base::number_unsigned_t value) override { return add(value); }
  bool number_float(typename Base::number_float_t value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(typename Base::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    Level& level = levels_.back();
    if (name.size() > kMaxKey || printable(name) != name)
      throw input_error(name_, path_to(excerpt(name)),
                        "has a control character or is longer than {} bytes, expected the name of a key", kMaxKey);
    level.key = name;
    if (level.value->size() == kMaxKeys)
      throw input_error(name_, path(), "is one too many, expected at most {} keys in an object", kMaxKeys);
    if (level.value->contains(name)) throw input_error(name_, path(), "is given twice, expected once");
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    const std::size_t at = position == 0 ? 0 : position - 1;
    const std::string where = name_ + ":" + place_in_text(text_, at);
    constexpr int kOverflow = 406;
    if (error.id == kOverflow)
      throw input_error(where, path(), "is a number too large for a double, expected at most 1.8e308 in magnitude");
    if (at < text_.size() && text_[at] == '#')
      throw input_error(where, "", "is a comment of another language, expected // or /* */");
    if (std::filesystem::path(name_).extension() == ".tir")
      throw input_error(
          where, "",
          "is a tire property file, expected JSON: the key tire.file of a scenario, or the key 'tir' of a tire "
          "in JSON, names such a file");
    std::string what = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing value - …"
    if (const std::size_t from = what.find(" - "); from != std::string::npos) what = what.substr(from + 3);
    if (const std::size_t from = what.find("; last read: '"); from != std::string::npos && what.size() > 120)
      what.resize(from);
    if (const std::string slip = likely_slip(text_, at); !slip.empty()) what = slip + " (" + what + ")";
    throw input_error(where, "", "is not valid JSON: " + what);
  }

 private:
  struct Level {
    Json* value;
    std::string key;
  };

  Json* place_for() {
    if (levels_.empty()) return &root_;
    Level& level = levels_.back();
    if (level.value->is_array()) {
      level.value->push_back(nullptr);
      return &level.value->back();
    }
    return &(*level.value)[level.key];
  }
  bool add(Json value) {
    *place_for() = std::move(value);
    return true;
  }
  bool open(Json value) {
    Json* at = place_for();
    *at = std::move(value);
    levels_.push_back({at, {}});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return true;
  }
  std::string path() const { return path_to(levels_.empty() ? "" : levels_.back().key); }
  /// Path of a key of the innermost object.
  std::string path_to(const std::string& key) const {
    std::string text;
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      const bool last = k + 1 == levels_.size();
      const Json& value = *levels_[k].value;
      text += (text.empty() ? "" : ".") + (value.is_array() ? std::to_string(value.size())
                                           : last           ? key
                                                            : levels_[k].key);
    }
    return text;
  }

  const std::string& text_;
  std::string name_;
  Json root_;
  std::vector<Level> levels_;
};

}  // namespace

template <class Json>
Json parse_json(const std::string& text, const std::string& name) {
  if (const std::size_t at = find_too_deep(text); at != std::string::npos)
    throw input_error(name + ":" + place_in_text(text, at), "", too_deep());
  Builder<Json> builder(text, name);
  constexpr bool kWhole = true, kComments = true;
  Json::sax_parse(text, &builder, nlohmann::detail::input_format_t::json, kWhole, kComments);
  return builder.take();
}
template nlohmann::json parse_json(const std::string&, const std::string&);
template nlohmann::ordered_json parse_json(const std::string&, const std::string&);

template <class Json>
Json load_json(const std::filesystem::path& file, const std::string& expected) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) refuse_meshes(file, expected);
  Json document = parse_json<Json>(read_text_file(file, expected), file.string());
  if (!document.is_object()) throw input_error(file.string(), "", "is not an object, expected " + expected);
  return document;
}
template nlohmann::json load_json(const std::filesystem::path&, const std::string&);
template nlohmann::ordered_json load_json(const std::filesystem::path&, const std::string&);

nlohmann::ordered_json read_json_if_whole(const std::filesystem::path& file) {
  using Json = nlohmann::ordered_json;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};  // reading a pipe would block
  try {
    return parse_json<Json>(read_whole_file(file, kMaxText), file.string());
  } catch (const Error&) {
    return {};
  }
}

json parse_value(const std::string& text, const std::string& name, const std::string& key) {
  if (find_invalid_utf8(text) != std::string::npos) throw input_error(name, key, "the value is not UTF-8");
  if (find_too_deep(text) != std::string::npos) throw input_error(name, key, too_deep());
  if (!json::accept(text)) {
    // A number that overflows is refused too, and not read as a string.
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0' && std::isinf(value) && text.find_first_of("nN") == std::string::npos)
      throw input_error(name, key,
                        "'" + text + "' is a number too large for a double, expected at most 1.8e308 in magnitude");
    return text;
  }
  return parse_json(text, name);
}

std::string number_text(double value) {
  const double size = std::abs(value);
  if (size >= 1e4 && size < 1e6 && std::fmod(value, 100.0) == 0.0) return fmt::format("{:g}e3", value / 1e3);
  if (value == std::round(value) && size < 1e6) return fmt::format("{}", std::llround(value));
  std::string text = fmt::format("{:g}", value);
  if (std::strtod(text.c_str(), nullptr) != value) text = fmt::format("{}", value);
  // Shortens 1e+09 and 4e-05 to 1e9 and 4e-5.
  for (const char* long_form : {"e+0", "e-0", "e+"})
    if (const std::size_t at = text.find(long_form); at != std::string::npos)
      return text.replace(at, std::strlen(long_form), long_form[1] == '-' ? "e-" : "e");
  return text;
}

template <class Json>
std::string value_text(const Json& value) {
  if (value.is_number()) return number_text(value.template get<double>());
  const std::string text = value.is_string() ? "'" + value.template get_ref<const std::string&>() + "'"
                                             : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return excerpt(text);
}
template std::string value_text(const nlohmann::json&);
template std::string value_text(const nlohmann::ordered_json&);

std::string one_of(const json& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + value_text(values[i]);
  return text;
}

}  // namespace furrow
