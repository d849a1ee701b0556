#include "protocol/files/hdf5_library.hpp"

#include <hdf5.h>

namespace furrow::hdf5 {

std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  return mutex;
}

void prepare() {
  // When a program ends, HDF5 1.10.8 would flush again a file that it could not write, and crash.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
}

}  // namespace furrow::hdf5
