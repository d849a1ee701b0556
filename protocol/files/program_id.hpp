// Which build of the program computes, and on which processor. What another build computes again may differ in its last
// bits, so that each build keeps its own.
#pragma once

#include <string>

namespace furrow {

/// A hash of the program's own file: another build has another one.
std::string build_id();
/// Distinguishes programs whose numbers may differ in their last bits: a digest of the compiler, its target and its
/// options for arithmetic, made when the build is configured, and a hash of what the C library's mathematics give here.
/// Sources do not count: whoever changes what is kept raises its format.
std::string arithmetic_id();
/// "model name" of the processor.
std::string cpu_model();

}  // namespace furrow
