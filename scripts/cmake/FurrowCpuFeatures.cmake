# furrow_cpu_features(<header> <flag>…): writes the instruction sets that <flag>… let the compiler use, beyond the
# plainest processor, as FURROW_CPU_FEATURES: FURROW_FEATURE("avx2") …, in the names of __builtin_cpu_supports.
function(furrow_cpu_features header)
  set(_wanted sse3 ssse3 sse4.1 sse4.2 sse4a popcnt avx avx2 fma fma4 xop bmi bmi2 f16c lzcnt movbe aes pclmul
    vaes vpclmulqdq gfni avxvnni avx512f avx512cd avx512bw avx512dq avx512vl avx512ifma avx512vbmi avx512vbmi2
    avx512vnni avx512bitalg avx512vpopcntdq avx512bf16 avx512fp16 amx-tile)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${ARGN} -dM -E -x c++ /dev/null
                  OUTPUT_VARIABLE _macros RESULT_VARIABLE _failed ERROR_QUIET)
  set(_list "")
  if(NOT _failed)
    foreach(_name ${_wanted})
      string(TOUPPER ${_name} _macro)
      string(REGEX REPLACE "[.-]" "_" _macro ${_macro})
      if(_macros MATCHES "#define __${_macro}__ ")
        # Only names that this compiler's __builtin_cpu_supports knows.
        file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/cpu_supports.cpp
          "bool f() { return __builtin_cpu_supports(\"${_name}\"); }\n")
        execute_process(COMMAND ${CMAKE_CXX_COMPILER} -c -o /dev/null ${CMAKE_CURRENT_BINARY_DIR}/cpu_supports.cpp
                        RESULT_VARIABLE _unknown OUTPUT_QUIET ERROR_QUIET)
        if(NOT _unknown)
          string(APPEND _list " FURROW_FEATURE(\"${_name}\")")
        endif()
      endif()
    endforeach()
  endif()
  file(CONFIGURE OUTPUT ${header} CONTENT "// Made by CMake.\n#pragma once\n#define FURROW_CPU_FEATURES@_list@\n" @ONLY)
endfunction()
