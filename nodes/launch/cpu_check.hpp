// Reports at start that a program was built for a richer processor, on which it would otherwise die of an illegal
// instruction. A program only has to link the object library furrow_cpu_check: the check runs before main and before
// the constructors of the program's own code. It is compiled for the plainest processor of the architecture.
#pragma once

namespace furrow::launch {

/// An instruction set that the build uses (cpu_features.hpp, made by CMake) and this processor lacks, or null.
const char* missing_instruction_set();

}  // namespace furrow::launch
