#include "protocol/files/hdf5_library.hpp"

#include <hdf5.h>

namespace furrow::hdf5 {

std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  return mutex;
}

void prepare() {
  // As a program ends, the library would flush a file once more that could not be written, and crash (1.10.8).
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
}

}  // namespace furrow::hdf5
