#include "tests/verification/record.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace furrow::verification {
namespace {

double relative_error(double value, double reference, double scale) {
  return std::abs(value - reference) / (scale > 0.0 ? scale : std::abs(reference));
}

void append(const std::string& test_case, const std::string& quantity, double value, double reference, double error,
            double tolerance, const std::string& source) {
  const char* path = std::getenv("FURROW_VERIFICATION_CSV");
  if (path == nullptr || *path == '\0') return;
  std::ofstream out(path, std::ios::app);
  if (out.tellp() == 0) out << "case,quantity,value,reference,relative_error,tolerance,source\n";
  out.precision(8);
  out << '"' << test_case << "\",\"" << quantity << "\"," << value << ',' << reference << ',';
  out.precision(2);
  out << error << ',' << tolerance << ",\"" << source << "\"\n";
}

}  // namespace

void verify(const std::string& test_case, const std::string& quantity, double value, double reference, double tolerance,
            const std::string& source, double scale) {
  const double error = relative_error(value, reference, scale);
  append(test_case, quantity, value, reference, error, tolerance, source);
  // Written so that a NaN fails.
  EXPECT_TRUE(error <= tolerance) << test_case << ", " << quantity << ": " << value << ", reference " << reference
                                  << " [" << source << "], relative error " << error << ", tolerance " << tolerance;
}

std::string brief(double x) { return fmt::format("{:.4g}", x); }

Worst::Worst(std::string test_case, std::string quantity, double tolerance, std::string source)
    : case_(std::move(test_case)), quantity_(std::move(quantity)), source_(std::move(source)), tolerance_(tolerance) {}

void Worst::add(double value, double reference, double scale, const std::string& where) {
  const double error = relative_error(value, reference, scale);
  ++points_;
  if (std::isnan(error_) || error <= error_) return;  // a NaN is worse than any number, whenever it comes
  value_ = value, reference_ = reference, scale_ = scale, error_ = error, where_ = where;
}

Worst::~Worst() {
  EXPECT_GT(points_, 0) << case_ << ", " << quantity_ << ": no points";
  const std::string where = where_.empty() ? "" : " at " + where_;
  if (points_ > 0) verify(case_, quantity_ + where, value_, reference_, tolerance_, source_, scale_);
}

}  // namespace furrow::verification
