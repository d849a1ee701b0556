// Result of an advance of a tire, a terrain or a rig. Partners report failures of physics or numerics only in this way.
// Errors of the user are thrown (error.hpp). A failure that may happen in any step is returned. The caller, which has
// the partner and the time, turns it into an Error(physics): physics_error(outcome, who, where).
#pragma once

#include <string>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow {

struct [[nodiscard]] Outcome {
  bool ok = true;      // the advance succeeded, and the state can be used
  std::string what;    // "did not converge", "reached its rim", "grain 17 left the bin"
  std::string detail;  // figures, and advice

  static Outcome failure(std::string what, std::string detail) { return {false, std::move(what), std::move(detail)}; }
  /// "WHO WHAT WHERE: DETAIL"; the caller states which partner and when.
  std::string message(const std::string& who, const std::string& where = "") const {
    return who + " " + what + where + (detail.empty() ? "" : ": " + detail);
  }
};

/// The failed outcome as an error, in the words of Outcome::message. @pre not ok
inline Error physics_error(const Outcome& outcome, const std::string& who, const std::string& where = "") {
  FURROW_ASSERT(!outcome.ok, who, where);
  return physics_error(outcome.message(who, where));
}

}  // namespace furrow
