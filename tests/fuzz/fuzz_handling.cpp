// Fuzzes tire property files, and tables of sweeps for their fits. A tire that was read, written and read again must
// give the same text.
#include <cmath>

#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tire/handling/sweep_table.hpp"
#include "tire/handling/tir_file.hpp"

namespace {

using namespace furrow;

void read_tire(const std::string& text) {
  const tire::handling::MagicFormula read = tire::handling::parse_tir(text, "fuzz.tir");
  const std::string written = tire::handling::tir_text(read, {});
  if (tire::handling::tir_text(tire::handling::parse_tir(written, "fuzz.tir"), {}) != written) __builtin_trap();
}

void read_table(const std::uint8_t* data, std::size_t size) {
  for (const tire::handling::SweepPoint& point :
       tire::handling::read_sweep_table(fuzz::input_file("sweep.csv", data, size)))
    if (!std::isfinite(point.state.slip) || !std::isfinite(point.loaded_radius)) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    if (text.find(",") != std::string::npos && text.find("[") == std::string::npos)
      read_table(data, size);
    else
      read_tire(text);
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
