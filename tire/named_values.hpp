// A few figures of a model under the model's own names, without allocation. Models count different things.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

struct NamedValue {
  const char* name = "";
  double value = 0.0;
};

class NamedValues {
 public:
  NamedValues() = default;
  NamedValues(std::initializer_list<NamedValue> values) {
    for (const NamedValue& value : values) add(value);
  }
  /// @pre fewer than kCapacity values are held
  void add(const NamedValue& value) {
    FURROW_ASSERT(size_ < kCapacity, size_);
    values_[size_++] = value;
  }
  /// 0 if no value has the name.
  double of(std::string_view name) const {
    for (const NamedValue& value : *this)
      if (value.name == name) return value.value;
    return 0.0;
  }
  const NamedValue* begin() const { return values_.data(); }
  const NamedValue* end() const { return values_.data() + size_; }

 private:
  static constexpr std::size_t kCapacity = 8;
  std::array<NamedValue, kCapacity> values_;
  std::size_t size_ = 0;
};

}  // namespace furrow::tire
