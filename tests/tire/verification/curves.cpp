#include "tests/tire/verification/curves.hpp"

#include <cstdlib>
#include <fstream>

namespace furrow::verification {

void curve_point(const std::string& test_case, const std::string& curve, double load, double deflection,
                 std::optional<double> reference) {
  const char* path = std::getenv("FURROW_VERIFICATION_CURVES");
  if (path == nullptr || *path == '\0') return;
  std::ofstream out(path, std::ios::app);
  if (out.tellp() == 0) out << "case,curve,load,deflection,reference\n";
  out.precision(6);
  out << '"' << test_case << "\",\"" << curve << "\"," << load << ',' << deflection << ',';
  if (reference) out << *reference;
  out << '\n';
}

}  // namespace furrow::verification
