// Tire files: our own layout and the public ANCFTire layout.
#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tire/read_tire_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  try {
    tire::TireFile file = tire::read_tire_file(fuzz::input_file("tire.json", data, size));
    tire::set_elements_width(file, 12);
  } catch (const Error&) {
  }
  return 0;
}
