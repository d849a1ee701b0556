// The parts that writer and reader of HDF5 files share.
#pragma once

#include <cstdint>
#include <mutex>

namespace furrow::hdf5 {

inline constexpr std::int64_t kFormatVersion = 1;  // of files that Furrow writes

/// Held by every open writer and reader, because the packaged library serves one thread at a time.
std::recursive_mutex& library();

/// Makes errors reach the user only as exceptions, and prevents files from loading plugins.
void prepare();

}  // namespace furrow::hdf5
