// Writes and reads message payloads: plain values, text, vectors, and structs with a list of fields (core/fields.hpp)
// in the order of the list. The byte order is the machine's own, as all ranks of a run are of one build.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Values that may be sent as their bytes: arithmetic types, enums, and the fixed-size vector types.
template <class T>
inline constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Vec3> ||
                                 std::is_same_v<T, Mat3> || std::is_same_v<T, std::array<int, 3>>;

class ByteWriter {
 public:
  template <class T>
  requires kIsPlain<T>
  void operator()(const T& value) { append(&value, sizeof value); }
  void operator()(const Quat& q) { append(q.coeffs().data(), 4 * sizeof(double)); }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    if constexpr (kIsPlain<T>) {
      append(values.data(), values.size() * sizeof(T));
    } else {
      for (const T& value : values) (*this)(value);
    }
  }
  template <HasFields T>
  void operator()(const T& values) {
    visit_fields(values, [this](const auto& value, const Field&) { (*this)(value); });
  }

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t count) {
    FURROW_ASSERT(from != nullptr || count == 0, count);
    const auto* bytes = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + count);
  }
  std::vector<std::byte> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(const std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <class T>
  requires kIsPlain<T>
  void operator()(T& value) { copy(&value, sizeof value); }
  void operator()(Quat& q) { copy(q.coeffs().data(), 4 * sizeof(double)); }
  void operator()(std::string& text) {
    text.resize(length(1));
    copy(text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    values.resize(length(kIsPlain<T> ? sizeof(T) : 1));
    if constexpr (kIsPlain<T>) {
      copy(values.data(), values.size() * sizeof(T));
    } else {
      for (T& value : values) (*this)(value);
    }
  }
  template <HasFields T>
  void operator()(T& values) {
    visit_fields(values, [this](auto& value, const Field&) { (*this)(value); });
  }
  /// @throws Error(rank_lost) if bytes are left over.
  void finish() const {
    if (at_ != bytes_.size()) throw Error(ExitCode::rank_lost, "a message is longer than its kind allows");
  }

 private:
  std::size_t length(std::size_t size_each) {
    FURROW_ASSERT(size_each > 0, size_each);
    std::uint64_t count = 0;
    (*this)(count);
    if (count > (bytes_.size() - at_) / size_each) fail();
    return count;
  }
  void copy(void* to, std::size_t count) {
    FURROW_ASSERT(at_ <= bytes_.size(), at_, bytes_.size());
    FURROW_ASSERT(to != nullptr || count == 0, count);
    if (count > bytes_.size() - at_) fail();
    if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
  }
  [[noreturn]] static void fail() { throw Error(ExitCode::rank_lost, "a message is shorter than its kind requires"); }

  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace furrow
