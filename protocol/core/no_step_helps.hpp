// Marks failures that a smaller step cannot avoid, so that the program does not suggest one.
#pragma once

namespace furrow {

/// Last words of the detail of such an Outcome.
inline constexpr char kNoStepHelps[] = "a smaller step does not help";

}  // namespace furrow
