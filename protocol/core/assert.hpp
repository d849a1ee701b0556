// Preconditions and invariants for tests of the program: checked in the builds dev, audit and asan (CMake option
// FURROW_ASSERTS), compiled to nothing in others.
//
//   FURROW_ASSERT(in_range(i, size()), i, size());
//
// prints "FILE:LINE: FUNCTION: precondition failed: in_range(i, size()) [i, size() = 12, 10]" and aborts. It never
// throws, so it may be used inside an OpenMP region. A mistake that a user can cause is an Error (error.hpp) or an
// Outcome (outcome.hpp), never an assertion.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

namespace furrow {

/// Whether `index` is one of `size` entries; for any integer types.
template <class Index, class Size>
constexpr bool in_range(Index index, Size size) {
  return std::cmp_greater_equal(index, 0) && std::cmp_less(index, size);
}

}  // namespace furrow

namespace furrow::detail {

/// The values, separated by commas; "…" for a value that no stream takes.
template <class... Values>
std::string values_text(const Values&... values) {
  std::ostringstream out;
  out.precision(17);
  [[maybe_unused]] const char* separator = "";
  [[maybe_unused]] const auto add = [&](const auto& value) {
    out << separator;
    if constexpr (requires { out << value; })
      out << value;
    else
      out << "…";
    separator = ", ";
  };
  (add(values), ...);
  return out.str();
}

[[noreturn]] inline void assertion_failed(const char* file, int line, const char* function, const char* condition,
                                          const char* names, const std::string& values) {
  std::fprintf(stderr, "%s:%d: %s: precondition failed: %s%s%s%s%s%s\n", file, line, function, condition,
               *names ? " [" : "", names, *names ? " = " : "", values.c_str(), *names ? "]" : "");
  std::abort();
}

}  // namespace furrow::detail

#ifndef NDEBUG
#define FURROW_ASSERT(condition, ...)                                                                          \
  ((condition) ? void(0)                                                                                       \
               : ::furrow::detail::assertion_failed(__FILE__, __LINE__, __func__, #condition, "" #__VA_ARGS__, \
                                                    ::furrow::detail::values_text(__VA_ARGS__)))
#else
// Compiled but not evaluated, so that variables used only by assertions count as used.
#define FURROW_ASSERT(condition, ...) \
  (void)sizeof((condition) ? (void(::furrow::detail::values_text(__VA_ARGS__)), 1) : 0)
#endif
