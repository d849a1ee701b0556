// Which build of the program computes, and on which processor.
#pragma once

#include <string>

namespace furrow {

/// A hash of the program's own file: another build has another one.
std::string build_id();
/// "model name" of the processor.
std::string cpu_model();

}  // namespace furrow
