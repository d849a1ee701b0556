// Tire files: our own layout and the public ANCFTire layout.
#include "protocol/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tire/tire_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  try {
    TireFile file = read_tire_file(fuzz::input_file("tire.json", data, size));
    set_elements_width(file, 12);
  } catch (const Error&) {
  }
  return 0;
}
