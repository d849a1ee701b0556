// What models of calibrations can leave beside the fitted file, such as files that it names: a capability beside the
// interface of kind.hpp, asked for by dynamic_cast.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace furrow::calibrate {

struct ResultFile {
  std::string name, text;
};

class LeavesFiles {
 public:
  virtual ~LeavesFiles() = default;
  /// Alike in number and names for all values. @param values of the parameters @param source as of the fitted file
  virtual std::vector<ResultFile> further_files(std::span<const double> values, const std::string& source) const = 0;
};

}  // namespace furrow::calibrate
