// Identifies the build of the program and the processor. Results of another build may differ in their last bits, so
// each build keeps its own.
#pragma once

#include <string>

namespace furrow {

/// A hash of the program's own file; every build has a different one.
std::string build_id();
/// Identifies programs whose numbers are equal to the last bit: a digest of the compiler, its target and its options
/// for arithmetic, made when the build is configured, and a hash of results of the C library's mathematics here.
/// Sources do not count: a change of what is kept must raise the version of its format.
std::string arithmetic_id();
/// The processor's "model name".
std::string cpu_model();

}  // namespace furrow
