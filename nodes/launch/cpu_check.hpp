// Says at start that a program was built for a richer processor, where it would otherwise die of an illegal
// instruction. Linking the object library furrow_cpu_check is all a program has to do: the check runs before main and
// before the constructors of its own code. It is compiled for the plainest processor of the architecture.
#pragma once

namespace furrow::launch {

/// An instruction set that the build uses (cpu_features.hpp, made by CMake) and this processor lacks; else null.
const char* missing_instruction_set();

}  // namespace furrow::launch
