// Structs with a list of fields (fields.hpp) in a saved state (archive.hpp). Every field has its own name: if one is
// added, moved or left out, the error names it, and no other field shifts.
//
//   number, switch, enumeration        one number: double, int64 and uint64 as they are, shorter integers as int32
//   vector, matrix, orientation        their numbers, a matrix column by column, an orientation x y z w
//   text                               its bytes
//   struct                             each of its fields as "<name>/<field>"
//   std::vector of any but structs     their numbers one after another
//   std::vector of structs             a column for each field, "<name>/<field>", with the numbers of all of them
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {
namespace detail {

/// How a value of type T is stored: kCount numbers of type Number.
template <class T>
struct Stored;

template <class T>
requires std::is_arithmetic_v<T> || std::is_enum_v<T>
struct Stored<T> {
  static constexpr bool kAsItIs =
      std::is_same_v<T, double> || std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::uint64_t>;
  static_assert(kAsItIs || (!std::is_floating_point_v<T> && sizeof(T) <= 4 && !std::is_same_v<T, unsigned>),
                "saved state has no type of number that holds all values of this field");
  using Number = std::conditional_t<kAsItIs, T, std::int32_t>;
  static constexpr std::size_t kCount = 1;
  static void add(std::vector<Number>& to, const T& value) { to.push_back(static_cast<Number>(value)); }
  static void take(const Number* from, T& value) { value = static_cast<T>(*from); }
};

template <class T>
requires requires { T::SizeAtCompileTime; }
struct Stored<T> {
  using Number = typename T::Scalar;
  static constexpr std::size_t kCount = T::SizeAtCompileTime;
  static void add(std::vector<Number>& to, const T& value) { to.insert(to.end(), value.data(), value.data() + kCount); }
  static void take(const Number* from, T& value) { std::copy_n(from, kCount, value.data()); }
};

template <>
struct Stored<Quat> {
  using Number = double;
  static constexpr std::size_t kCount = 4;
  static void add(std::vector<double>& to, const Quat& value) {
    to.insert(to.end(), value.coeffs().data(), value.coeffs().data() + kCount);
  }
  static void take(const double* from, Quat& value) { std::copy_n(from, kCount, value.coeffs().data()); }
};

template <class T, std::size_t N>
struct Stored<std::array<T, N>> {
  using Number = typename Stored<T>::Number;
  static constexpr std::size_t kCount = N * Stored<T>::kCount;
  static void add(std::vector<Number>& to, const std::array<T, N>& values) {
    for (const T& value : values) Stored<T>::add(to, value);
  }
  static void take(const Number* from, std::array<T, N>& values) {
    for (T& value : values) Stored<T>::take(from, value), from += Stored<T>::kCount;
  }
};

inline std::string field_path(const std::string& name, const Field& field) {
  return name.empty() ? field.name : name + "/" + field.name;
}

/// Calls f(path, value) for every field of a struct and of the structs in it, in their order.
template <HasFields S, class F>
void each_leaf(const std::string& name, S& values, F&& f) {
  visit_fields(values, [&](auto& value, const Field& field) {
    if constexpr (HasFields<std::remove_cvref_t<decltype(value)>>)
      each_leaf(field_path(name, field), value, f);
    else
      f(field_path(name, field), value);
  });
}

/// Calls f(value) for the same fields in the same order.
template <HasFields S, class F>
void each_leaf_value(S& values, F&& f) {
  visit_fields(values, [&](auto& value, const Field&) {
    if constexpr (HasFields<std::remove_cvref_t<decltype(value)>>)
      each_leaf_value(value, f);
    else
      f(value);
  });
}

}  // namespace detail

/// Gathers structs for a saved state, a column for each field:
/// `ColumnWriter<Row> rows; for (…) rows.add(row); rows.put(archive, "rows");`
template <HasFields S>
class ColumnWriter {
 public:
  ColumnWriter() {
    const S none{};
    detail::each_leaf("", none, [&]<class T>(const std::string& path, const T&) {
      columns_.emplace_back(path, std::vector<typename detail::Stored<T>::Number>());
    });
  }
  void add(const S& values) {
    auto column = columns_.begin();
    detail::each_leaf_value(values, [&]<class T>(const T& value) {
      detail::Stored<T>::add(std::get<std::vector<typename detail::Stored<T>::Number>>(column->second), value);
      ++column;
    });
  }
  void put(Archive& archive, const std::string& name) const {
    for (const auto& [path, numbers] : columns_)
      std::visit([&, &path = path](const auto& n) { archive.put(name + "/" + path, n); }, numbers);
  }

 private:
  std::vector<std::pair<std::string, Archive::Array>> columns_;
};

/// Takes structs one after another as ColumnWriter put them. The archive must outlive it.
template <HasFields S>
class ColumnReader {
 public:
  /// Takes all structs that there are. @throws Error(io) when a column is missing or longer or shorter than the first
  ColumnReader(const Archive& archive, const std::string& name)
      : ColumnReader(archive, name, count_in(archive, name)) {}
  /// @throws Error(io) when a column is missing or does not hold `count` values
  ColumnReader(const Archive& archive, const std::string& name, std::size_t count) : count_(count) {
    const S none{};
    detail::each_leaf(name, none, [&]<class T>(const std::string& path, const T&) {
      using Stored = detail::Stored<T>;
      next_.emplace_back(archive.get<typename Stored::Number>(path, count * Stored::kCount).data());
    });
  }
  std::size_t count() const { return count_; }
  /// @pre take() was called less than count() times
  void take(S& values) {
    auto next = next_.begin();
    detail::each_leaf_value(values, [&]<class T>(T& value) {
      using Stored = detail::Stored<T>;
      auto& from = std::get<const typename Stored::Number*>(*next);
      Stored::take(from, value);
      from += Stored::kCount;
      ++next;
    });
  }

 private:
  static std::size_t count_in(const Archive& archive, const std::string& name) {
    const S none{};
    std::size_t count = 0;
    bool first = true;
    detail::each_leaf(name, none, [&]<class T>(const std::string& path, const T&) {
      using Stored = detail::Stored<T>;
      if (std::exchange(first, false)) count = archive.get<typename Stored::Number>(path).size() / Stored::kCount;
    });
    return count;
  }

  std::size_t count_;
  std::vector<std::variant<const double*, const std::int64_t*, const std::int32_t*, const std::uint64_t*>> next_;
};

/// One value under its name.
template <class T>
void save_value(Archive& archive, const std::string& name, const T& value) {
  std::vector<typename detail::Stored<T>::Number> numbers;
  detail::Stored<T>::add(numbers, value);
  archive.put(name, numbers);
}
inline void save_value(Archive& archive, const std::string& name, const std::string& text) {
  archive.put(name, std::vector<std::uint8_t>(text.begin(), text.end()));
}
template <class T>
void save_value(Archive& archive, const std::string& name, const std::vector<T>& values) {
  if constexpr (HasFields<T>) {
    ColumnWriter<T> columns;
    for (const T& one : values) columns.add(one);
    columns.put(archive, name);
  } else {
    std::vector<typename detail::Stored<T>::Number> numbers;
    numbers.reserve(detail::Stored<T>::kCount * values.size());
    for (const T& one : values) detail::Stored<T>::add(numbers, one);
    archive.put(name, numbers);
  }
}

/// Reads what save_value wrote. @throws Error(io) when it is missing, of another type or of another size
template <class T>
void restore_value(const Archive& archive, const std::string& name, T& value) {
  using Stored = detail::Stored<T>;
  Stored::take(archive.get<typename Stored::Number>(name, Stored::kCount).data(), value);
}
inline void restore_value(const Archive& archive, const std::string& name, std::string& text) {
  const auto& bytes = archive.get<std::uint8_t>(name);
  text.assign(bytes.begin(), bytes.end());
}
/// @throws Error(io) as above, and unless there are `count` values
template <class T>
void restore_value(const Archive& archive, const std::string& name, std::vector<T>& values, std::size_t count) {
  using Stored = detail::Stored<T>;
  const auto* from = archive.get<typename Stored::Number>(name, count * Stored::kCount).data();
  values.assign(count, T{});
  for (T& one : values) Stored::take(from, one), from += Stored::kCount;
}
/// Reads as many values as there are.
template <class T>
void restore_value(const Archive& archive, const std::string& name, std::vector<T>& values) {
  if constexpr (HasFields<T>) {
    ColumnReader<T> columns(archive, name);
    values.assign(columns.count(), T{});
    for (T& one : values) columns.take(one);
  } else {
    using Stored = detail::Stored<T>;
    restore_value(archive, name, values, archive.get<typename Stored::Number>(name).size() / Stored::kCount);
  }
}

/// Saves every field of a struct under "<name>/<field>"; with an empty name under "<field>".
template <HasFields S>
void save_fields(Archive& archive, const std::string& name, const S& values) {
  detail::each_leaf(name, values,
                    [&](const std::string& path, const auto& value) { save_value(archive, path, value); });
}

/// Reads what save_fields wrote. @throws Error(io) naming the field that is missing, of another type or of another size
template <HasFields S>
void restore_fields(const Archive& archive, const std::string& name, S& values) {
  detail::each_leaf(name, values, [&](const std::string& path, auto& value) { restore_value(archive, path, value); });
}

}  // namespace furrow
