// A node's saved state: named arrays of numbers. A checkpoint contains it, and a round trip within one process passes
// it. Names are paths ("grains/x"); values are kept bit for bit.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow {

class Archive {
 public:
  using Array = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::int32_t>,
                             std::vector<std::uint64_t>, std::vector<std::uint8_t>>;

  template <class T>
  void put(const std::string& name, std::span<const T> values) {
    arrays_[prefix_ + name] = std::vector<T>(values.begin(), values.end());
  }
  template <class T>
  void put(const std::string& name, const std::vector<T>& values) {
    arrays_[prefix_ + name] = values;
  }
  void put(const std::string& name, double value) { put(name, std::vector<double>{value}); }
  void put(const std::string& name, std::int64_t value) { put(name, std::vector<std::int64_t>{value}); }

  /// @throws Error(io) when the array is missing or of another type.
  template <class T>
  const std::vector<T>& get(const std::string& name) const {
    const auto found = arrays_.find(prefix_ + name);
    if (found == arrays_.end()) throw Error(ExitCode::io, "saved state lacks '" + prefix_ + name + "'");
    const auto* values = std::get_if<std::vector<T>>(&found->second);
    if (!values) throw Error(ExitCode::io, "saved state holds '" + prefix_ + name + "' as another type");
    return *values;
  }
  /// As get, and the length must be `size`.
  template <class T>
  const std::vector<T>& get(const std::string& name, std::size_t size) const {
    const auto& values = get<T>(name);
    if (values.size() != size)
      throw Error(ExitCode::io, "saved state '" + prefix_ + name + "' has " + std::to_string(values.size()) +
                                    " values, expected " + std::to_string(size));
    return values;
  }
  double get_double(const std::string& name) const { return get<double>(name, 1).front(); }
  std::int64_t get_int(const std::string& name) const { return get<std::int64_t>(name, 1).front(); }
  void remove(const std::string& name) { arrays_.erase(prefix_ + name); }
  bool has(const std::string& name) const { return arrays_.count(prefix_ + name) != 0; }

  /// Puts `folder` in front of all names while it lives: `Archive::Scope scope(archive, "tire/");`
  /// @pre the folder ends in a slash
  class Scope {
   public:
    Scope(const Archive& archive, const std::string& folder) : archive_(archive), before_(archive.prefix_) {
      FURROW_ASSERT(!folder.empty() && folder.back() == '/', folder);
      archive_.prefix_ += folder;
    }
    ~Scope() { archive_.prefix_ = before_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    const Archive& archive_;
    std::string before_;
  };

  const std::map<std::string, Array>& arrays() const { return arrays_; }
  void put_array(const std::string& name, Array values) { arrays_[name] = std::move(values); }

 private:
  std::map<std::string, Array> arrays_;
  mutable std::string prefix_;  // selects the names that are seen, not what the archive contains
};

}  // namespace furrow
