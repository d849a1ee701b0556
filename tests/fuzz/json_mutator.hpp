// Changes documents instead of bytes: sets values of odd kinds and sizes; removes, doubles and exchanges keys and
// entries. Include it in a target that reads JSON. libFuzzer changes texts that are not JSON, and makes one change in
// eight.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace furrow::fuzz {

using Json = nlohmann::ordered_json;

class JsonMutator {
 public:
  explicit JsonMutator(unsigned seed) : chance_(seed) {}

  /// Makes one to four changes. @param other a further source of values
  void change(Json& document, const Json& other) {
    for (std::size_t k = 1 + below(4); k > 0; --k) {
      std::vector<Json*> places, gifts;
      collect(document, places);
      Json given = other;
      collect(given, gifts);
      change_one(*places[below(places.size())], places, *gifts[below(gifts.size())]);
    }
  }

  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(chance_); }

 private:
  static void collect(Json& value, std::vector<Json*>& places) {
    places.push_back(&value);
    if (value.is_structured())
      for (Json& inner : value) collect(inner, places);
  }

  /// A random entry; iterators of objects cannot jump. @pre there is one
  Json::iterator any_of(Json& value) {
    return std::next(value.begin(), static_cast<std::ptrdiff_t>(below(value.size())));
  }

  Json odd() {
    switch (below(12)) {
      case 0:
        return nullptr;
      case 1:
        return below(2) == 1;
      case 2:
        return Json::array();
      case 3:
        return Json::object();
      case 4:
        return Json::array({below(3), -0.5});
      case 5: {
        static constexpr const char* kTexts[] = {"", "x", "auto", "a.b", "0", "../..", "/", "\n", "ü", "%s"};
        return kTexts[below(std::size(kTexts))];
      }
      case 6:
        return std::string(below(2) == 1 ? 70 : 5000, 'a');
      case 7:
        return std::uniform_int_distribution<std::int64_t>(INT64_MIN, INT64_MAX)(chance_);
      default: {
        static constexpr double kNumbers[] = {0,     1,      -1,     0.5,  2,     1e-9,   1e9, 1e15,
                                              1e308, -1e308, 5e-324, 1e-4, 1e300, 1e-300, 64,  -0.0};
        const double x = kNumbers[below(std::size(kNumbers))];
        if (below(2) == 1 && std::abs(x) < 1e16) return static_cast<std::int64_t>(x);
        return x;
      }
    }
  }

  void change_number(Json& at) {
    const double x = at.get<double>();
    switch (below(5)) {
      case 0:
        at = -x;
        break;
      case 1:
        at = x * std::pow(10.0, static_cast<double>(below(13)) - 6.0);
        break;
      case 2:
        at = x * std::uniform_real_distribution<double>(0.0, 2.0)(chance_);
        break;
      case 3:
        at =
            std::abs(x) < 1e15 ? Json(static_cast<std::int64_t>(x) + static_cast<std::int64_t>(below(5)) - 2) : Json(0);
        break;
      default:
        at = odd();
    }
    if (at.is_number_float() && !std::isfinite(at.get<double>())) at = 1e308;
  }

  void change_text(Json& at) {
    std::string text = at.get<std::string>();
    const std::size_t size = text.size();
    text.resize(size + 8);
    text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
    at = text;
  }

  void change_structure(Json& at) {
    const bool keyed = at.is_object();
    if (at.empty() || below(6) == 0) {
      if (keyed)
        at[below(2) == 1 ? "x" : ""] = odd();
      else
        at.push_back(odd());
      return;
    }
    const auto entry = any_of(at);
    switch (below(4)) {
      case 0:
      case 1:
        at.erase(entry);
        break;
      case 2: {
        const Json copy = *entry;
        if (keyed)
          at["again"] = copy;
        else
          for (std::size_t k = below(6) == 0 ? 40 : 1; k > 0; --k) at.push_back(copy);
        break;
      }
      default:
        std::swap(*entry, *any_of(at));
    }
  }

  void change_one(Json& at, const std::vector<Json*>& places, const Json& gift) {
    switch (below(8)) {
      case 0:
        at = odd();
        return;
      case 1: {  // copied first: one may be within the other
        const Json copy = *places[below(places.size())];
        at = copy;
        return;
      }
      case 2:
        at = gift;
        return;
      case 3:
        at = below(2) == 1 ? Json::array({Json(at)}) : Json{{"x", Json(at)}};
        return;
      default:
        break;
    }
    if (at.is_number())
      change_number(at);
    else if (at.is_string())
      change_text(at);
    else if (at.is_structured())
      change_structure(at);
    else
      at = odd();
  }

  std::minstd_rand chance_;
};

inline Json parsed(const std::uint8_t* data, std::size_t size) {
  return Json::parse(data, data + size, nullptr, false);
}

/// Writes a document as bytes. @returns its size, 0 when it does not fit
inline std::size_t stored(const Json& document, std::uint8_t* data, std::size_t max_size) {
  const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > max_size) return 0;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace furrow::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace furrow::fuzz;
  JsonMutator mutator(seed);
  Json document = parsed(data, size);
  if (document.is_discarded() || mutator.below(8) == 0) return LLVMFuzzerMutate(data, size, max_size);
  mutator.change(document, document);
  const std::size_t count = stored(document, data, max_size);
  return count > 0 ? count : LLVMFuzzerMutate(data, size, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second, std::size_t second_size, std::uint8_t* out,
                                                 std::size_t max_size, unsigned seed) {
  using namespace furrow::fuzz;
  Json document = parsed(first, first_size);
  const Json other = parsed(second, second_size);
  if (document.is_discarded() || other.is_discarded()) return 0;
  JsonMutator(seed).change(document, other);
  return stored(document, out, max_size);
}
