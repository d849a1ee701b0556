#include "protocol/files/program_id.hpp"

#include <cmath>
#include <fstream>

#include "protocol/core/hash.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow {

std::string build_id() {
  static const std::string id = file_hash("/proc/self/exe");
  return id;
}

namespace {

/// Hash of results of the C library's functions. It chooses variants by the processor and settings, with or without
/// fused multiplication, which round differently for one argument in some hundred or thousand. As the arguments are
/// volatile, the compiler folds nothing.
std::string mathematics_id() {
  constexpr int kArguments = 4096;  // without FMA 42 results of glibc 2.36 differ; takes 2 ms
  Hash hash;
  for (int k = 1; k <= kArguments; ++k) {
    const volatile double any = 0.618033988749895 * k / 101.0;  // 0.006 to 25
    const double x = any, part = x - std::floor(x);
    for (const double result :
         {std::exp(-x),        std::exp2(part),  std::expm1(-part),    std::log(x),        std::log2(x),
          std::log10(x),       std::log1p(part), std::pow(x, 1.5),     std::pow(x, -0.25), std::cbrt(x),
          std::hypot(x, part), std::sin(x),      std::cos(x),          std::tan(x),        std::asin(part),
          std::acos(part),     std::atan(x),     std::atan2(part, -x), std::sinh(part),    std::cosh(part),
          std::tanh(part),     std::erf(part)})
      hash.add(&result, sizeof result);
  }
  return hash.hex();
}

}  // namespace

std::string arithmetic_id() {
  static const std::string id = std::string(FURROW_ARITHMETIC) + "-" + mathematics_id();
  return id;
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace furrow
