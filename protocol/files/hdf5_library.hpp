// What writer and reader of HDF5 files share.
#pragma once

#include <cstdint>
#include <mutex>

namespace furrow::hdf5 {

inline constexpr std::int64_t kFormatVersion = 1;  // of what we write

/// Held by every open writer and reader: the library as packaged serves one thread at a time.
std::recursive_mutex& library();

/// Errors reach the user through exceptions alone, and no file can have a plugin loaded.
void prepare();

}  // namespace furrow::hdf5
