// A refused scenario, with warnings of unlikely values that may be the cause.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "protocol/core/error.hpp"

namespace furrow::scenario {

class RefusedScenario : public Error {
 public:
  RefusedScenario(const Error& error, std::vector<std::string> warnings)
      : Error(error), warnings_(std::move(warnings)) {}
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> warnings_;
};

}  // namespace furrow::scenario
