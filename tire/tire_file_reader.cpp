#include "tire/tire_file_reader.hpp"

namespace furrow::tire {
namespace {

constexpr int kFormatVersion = 1;

}  // namespace

void take_common_keys(JsonReader& reader) {
  reader.check_version(kFormatVersion, true);
  for (const char* key : {"model", "rim", "name", "source", "$schema"}) reader.skip(key);
}

}  // namespace furrow::tire
