// How a failure says that its run cannot avoid it by stepping more finely: no such way out is offered then.
#pragma once

namespace furrow {

/// Ends the detail of such an Outcome.
inline constexpr char kNoStepHelps[] = "a smaller step does not help";

}  // namespace furrow
