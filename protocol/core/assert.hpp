// Preconditions and invariants of the program, checked in every build: a mistake of its own ends a run with a line that
// names it, instead of a wrong number. The CMake option FURROW_ASSERTS=OFF compiles them to nothing.
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

/// Takes values instead of references, so that the variables of a caller stay in registers, and is never inlined: a
/// condition that holds costs a comparison.
template <class... Values>
[[noreturn, gnu::cold, gnu::noinline]] void assertion_failed(const char* file, int line, const char* function,
                                                             const char* condition, const char* names,
                                                             Values... values) {
  std::fprintf(stderr, "%s:%d: %s: precondition failed: %s%s%s%s%s%s\n", file, line, function, condition,
               *names ? " [" : "", names, *names ? " = " : "", values_text(values...).c_str(), *names ? "]" : "");
  std::abort();
}

}  // namespace furrow::detail

#ifndef NDEBUG
#define FURROW_ASSERT(condition, ...)                                                         \
  ((condition) ? void(0)                                                                      \
               : ::furrow::detail::assertion_failed(__FILE__, __LINE__, __func__, #condition, \
                                                    "" #__VA_ARGS__ __VA_OPT__(, ) __VA_ARGS__))
#else
// Compiled but not evaluated, so that variables used only by assertions count as used.
#define FURROW_ASSERT(condition, ...) \
  (void)sizeof((condition) ? (void(::furrow::detail::values_text(__VA_ARGS__)), 1) : 0)
#endif
