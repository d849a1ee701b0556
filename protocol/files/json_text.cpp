#include "protocol/files/json_text.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxText = 16 << 20;  // bytes
constexpr std::size_t kMaxValue = 60;          // characters shown of a value

/// Offset of the first byte that is not UTF-8 (RFC 3629), or npos.
std::size_t find_invalid_utf8(const std::string& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte(i);
    const int more = lead < 0x80                   ? 0
                     : lead >= 0xC2 && lead < 0xE0 ? 1
                     : lead >= 0xE0 && lead < 0xF0 ? 2
                     : lead >= 0xF0 && lead < 0xF5 ? 3
                                                   : -1;
    if (more < 0 || lead == 0 || i + static_cast<std::size_t>(more) >= text.size()) return i;
    unsigned code = more == 0 ? lead : lead & (0x3FU >> more);
    for (int k = 1; k <= more; ++k) {
      if ((byte(i + static_cast<std::size_t>(k)) & 0xC0U) != 0x80U) return i;
      code = code << 6 | (byte(i + static_cast<std::size_t>(k)) & 0x3FU);
    }
    const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
    if (overlong || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF) return i;
    i += 1 + static_cast<std::size_t>(more);
  }
  return std::string::npos;
}

/// "line:column", both from 1, the column in characters.
std::string place(const std::string& text, std::size_t offset) {
  offset = std::min(offset, text.size());
  const std::size_t line = 1 + static_cast<std::size_t>(std::count(
                                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
  const std::size_t newline = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  std::size_t column = 1;
  for (std::size_t i = newline == std::string::npos ? 0 : newline + 1; i < offset; ++i)
    column += (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
  return fmt::format("{}:{}", line, column);
}

/// Builds a document event by event, so that keys can be checked as they come.
class Builder final : public nlohmann::json_sax<json> {
 public:
  Builder(const std::string& text, std::string name) : text_(text), name_(std::move(name)) {}

  json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.key = name;
    if (level.value->contains(name)) throw input_error(name_, path(), "is given twice, expected once");
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const std::string where = name_ + ":" + place(text_, position == 0 ? 0 : position - 1);
    constexpr int kOverflow = 406;
    if (error.id == kOverflow)
      throw input_error(where, path(),
                        "is a number too large for a double, expected at most 1.8e308 in magnitude");
    std::string what = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing value -
    // …"
    if (const std::size_t at = what.find(" - "); at != std::string::npos) what = what.substr(at + 3);
    if (const std::size_t at = what.find("; last read: '"); at != std::string::npos && what.size() > 120)
      what.resize(at);
    throw input_error(where, "", "is not valid JSON: " + what);
  }

 private:
  struct Level {
    json* value;
    std::string key;
  };

  /// Where the next value goes.
  json* place_for() {
    if (levels_.empty()) return &root_;
    Level& level = levels_.back();
    if (level.value->is_array()) {
      level.value->push_back(nullptr);
      return &level.value->back();
    }
    return &(*level.value)[level.key];
  }
  bool add(json value) {
    *place_for() = std::move(value);
    return true;
  }
  bool open(json value) {
    json* at = place_for();
    *at = std::move(value);
    levels_.push_back({at, {}});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return true;
  }
  std::string path() const {
    std::string text;
    for (const Level& level : levels_) {
      const std::string part = level.value->is_array() ? std::to_string(level.value->size()) : level.key;
      text += (text.empty() ? "" : ".") + part;
    }
    return text;
  }

  const std::string& text_;
  std::string name_;
  json root_;
  std::vector<Level> levels_;
};

}  // namespace

std::string read_text_file(const std::filesystem::path& file, const std::string& expected) {
  const std::string name = file.string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw input_error(
        name, "",
        (error && error.value() != ENOENT ? "cannot be read (" + error.message() + ")" : "does not exist") +
            ", expected " + expected);
  if (std::filesystem::is_directory(status))
    throw input_error(name, "", "is a directory, expected " + expected);
  if (!std::filesystem::is_regular_file(status))
    throw input_error(name, "", "is not a regular file, expected " + expected);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > kMaxText)
    throw input_error(name, "",
                      fmt::format("is {} MB large, expected {} of at most 16 MB", size >> 20, expected));
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw input_error(name, "",
                      fmt::format("cannot be read ({}), expected {}", std::strerror(errno), expected));
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (std::all_of(text.begin(), text.end(),
                  [](unsigned char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }))
    throw input_error(name, "", "is empty, expected " + expected);
  if (const std::size_t bad = find_invalid_utf8(text); bad != std::string::npos)
    throw input_error(name + ":" + place(text, bad), "",
                      fmt::format("byte 0x{:02x} is not UTF-8, expected {} in UTF-8",
                                  static_cast<unsigned char>(text[bad]), expected));
  return text;
}

json parse_json(const std::string& text, const std::string& name) {
  Builder builder(text, name);
  json::sax_parse(text, &builder);
  return builder.take();
}

json parse_value(const std::string& text, const std::string& name, const std::string& key) {
  if (find_invalid_utf8(text) != std::string::npos) throw input_error(name, key, "the value is not UTF-8");
  if (!json::accept(text)) {
    // A number that overflows is not accepted either, but no string was meant.
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0' && std::isinf(value) &&
        text.find_first_of("nN") == std::string::npos)
      throw input_error(
          name, key,
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
  // 1e+09 and 4e-05 as 1e9 and 4e-5.
  for (const char* long_form : {"e+0", "e-0", "e+"})
    if (const std::size_t at = text.find(long_form); at != std::string::npos)
      return text.replace(at, std::strlen(long_form), long_form[1] == '-' ? "e-" : "e");
  return text;
}

std::string value_text(const json& value) {
  if (value.is_number()) return number_text(value.get<double>());
  std::string text = value.is_string() ? "'" + value.get<std::string>() + "'"
                                       : value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() <= kMaxValue) return text;
  std::size_t cut = kMaxValue - 3;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;
  return text.substr(0, cut) + "…";
}

std::string one_of(const json& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + value_text(values[i]);
  return text;
}

}  // namespace furrow
