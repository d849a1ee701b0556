// One check of the verification suite: computed value, reference, tolerance, and the reference's source. With the
// environment variable FURROW_VERIFICATION_CSV set, every check is appended to that file: case, quantity, value,
// reference, relative error, tolerance, source.
#pragma once

#include <string>

namespace furrow::verification {

/// Compares one value. The relative error is |value − reference| / scale; scale 0 stands for |reference|.
void verify(const std::string& test_case, const std::string& quantity, double value, double reference, double tolerance,
            const std::string& source, double scale = 0.0);

/// A short form of a number, for names of points.
std::string brief(double x);

/// Compares a curve, or one quantity of many similar cases; records the point with the largest error.
class Worst {
 public:
  Worst(std::string test_case, std::string quantity, double tolerance, std::string source);
  Worst(const Worst&) = delete;
  Worst& operator=(const Worst&) = delete;
  ~Worst();  // records and judges

  /// `where` names the point in the failure message.
  void add(double value, double reference, double scale = 0.0, const std::string& where = "");

 private:
  std::string case_, quantity_, source_, where_;
  double tolerance_ = 0.0, value_ = 0.0, reference_ = 0.0, scale_ = 0.0, error_ = -1.0;
  int points_ = 0;
};

}  // namespace furrow::verification
