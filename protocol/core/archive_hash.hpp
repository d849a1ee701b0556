// The hash of a saved state: equal bits of all arrays, by name, give equal hashes.
#pragma once

#include <span>

#include "protocol/core/archive.hpp"
#include "protocol/core/hash.hpp"

namespace furrow {

/// FNV-1a over names and bytes in the order of the names.
inline Hash archive_hash(const Archive& archive) {
  Hash hash;
  for (const auto& [name, array] : archive.arrays()) {
    hash.add(name);
    std::visit([&hash](const auto& values) { hash.add(std::span(values)); }, array);
  }
  return hash;
}

}  // namespace furrow
