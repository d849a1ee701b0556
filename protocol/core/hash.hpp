// FNV-1a over bytes: digests of scenarios and beds, and the hash of a final state. Not for security.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/core/assert.hpp"

namespace furrow {

class Hash {
 public:
  void add(const void* bytes, std::size_t count) {
    FURROW_ASSERT(bytes != nullptr || count == 0, count);
    const auto* p = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ p[i]) * 1099511628211ULL;
  }
  void add(std::string_view text) { add(text.data(), text.size()); }
  template <class T>
  void add(std::span<const T> values) {
    add(values.data(), values.size_bytes());
  }
  std::uint64_t value() const { return value_; }
  std::string hex() const {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (int i = 0; i < 16; ++i) text[i] = kDigits[(value_ >> (60 - 4 * i)) & 15];
    return text;
  }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

}  // namespace furrow
