// Places where tests make the program die, stop or fail. In `furrow` the call does nothing. tests/system/furrow_faults
// is the same program, linked with tests/system/fault_injection.cpp instead of fault_point.cpp.
#pragma once

#include <string>

namespace furrow {

/// Names: "step", "frame", "checkpoint.write", "checkpoint.written", "checkpoint.manifest", "checkpoint.rename",
/// "checkpoint.done", "results", "done". @throws what a test asks for
void fault_point(const char* name);

/// Text that a test passes at this point to a library that the program uses; empty: none. Names: "liggghts".
std::string fault_text(const char* name);

}  // namespace furrow
