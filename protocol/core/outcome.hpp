// How an advance of a tire, a terrain or a rig ended: the one way in which partners report that physics or numerics
// failed. Errors of the user are thrown (error.hpp); what may happen in any step is returned, and becomes an
// Error(physics) only where the caller knows which partner it was, and when: physics_error(outcome, who, where).
#pragma once

#include <string>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow {

struct [[nodiscard]] Outcome {
  bool ok = true;      // and the state can be used
  std::string what;    // "did not converge", "reached its rim", "grain 17 left the bin"
  std::string detail;  // figures, and what to try

  static Outcome failure(std::string what, std::string detail) { return {false, std::move(what), std::move(detail)}; }
  /// "WHO WHAT WHERE: DETAIL", the caller's words for which partner and when.
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
