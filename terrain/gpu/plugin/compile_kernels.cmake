# Compiles the library of the GPU and fails if a kernel of every step needs too many registers or spills them:
#   cmake -DNVCC=… -DHOST=… -DROOT=… -DEIGEN=… -DOUT=… "-DSOURCES=…;…" -P compile_kernels.cmake
set(_most_registers 80)  # of the forces between grains: 24 warps of a multiprocessor, enough to hide its memory
set(_flags -std=c++20 -O3 -fmad=false --expt-relaxed-constexpr -cudart static -ccbin ${HOST}
  -Xcompiler -fPIC,-O2,-ffp-contract=off,-fno-math-errno,-Wno-psabi -I ${ROOT} -isystem ${EIGEN}
  -Xcudafe --diag_error=68 -gencode arch=compute_80,code=sm_80
  -gencode arch=compute_90,code=sm_90 -gencode arch=compute_90,code=compute_90 -Xptxas -v)
# Compiled together, they read the headers once for each architecture.
list(TRANSFORM SOURCES REPLACE "(.+)" "#include \"\\1\"\n")
list(JOIN SOURCES "" _together)
file(WRITE ${OUT}.cu "${_together}")
execute_process(COMMAND ${NVCC} ${_flags} ${OUT}.cu -shared -o ${OUT}.part
  RESULT_VARIABLE _failed OUTPUT_VARIABLE _log ERROR_VARIABLE _more)
set(_log "${_log}${_more}")
file(WRITE ${OUT}.log "${_log}")
if(_failed)
  message(FATAL_ERROR "nvcc failed:\n${_log}")
endif()

string(REGEX REPLACE "[][;]" " " _log "${_log}")
set(_line "[^\n]*\n")
string(REGEX MATCHALL "Compiling entry function '[^']*(PairKernel|MoveKernel)${_line}${_line}${_line}[^\n]*" _kernels
  "${_log}")
list(LENGTH _kernels _count)
if(_count LESS 10)  # two laws with and without rolling resistance, and the motion, for each architecture
  message(FATAL_ERROR "${OUT}.log names ${_count} kernels of a step, expected 10")
endif()
foreach(_kernel IN LISTS _kernels)
  string(REGEX MATCH "'([^']*)' for '([^']*)'" _name "${_kernel}")
  string(REGEX MATCH "Used ([0-9]+) registers" _matched "${_kernel}")
  set(_used ${CMAKE_MATCH_1})
  string(REGEX MATCH "([0-9]+) bytes spill stores, ([0-9]+) bytes spill loads" _spilled "${_kernel}")
  if(NOT _spilled STREQUAL "0 bytes spill stores, 0 bytes spill loads" OR _used GREATER ${_most_registers})
    message(FATAL_ERROR "${_name} uses ${_used} registers, ${_spilled}; expected at most ${_most_registers} and none")
  endif()
endforeach()
file(RENAME ${OUT}.part ${OUT})
