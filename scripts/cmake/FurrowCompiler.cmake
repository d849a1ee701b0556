# furrow_interface: flags of every program that includes the headers, also outside of this project.
# furrow_options: what every target of the project is compiled with beyond that.
add_library(furrow_interface INTERFACE)
add_library(furrow_options INTERFACE)
target_link_libraries(furrow_options INTERFACE furrow_interface)
target_include_directories(furrow_interface INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>)
target_compile_features(furrow_interface INTERFACE cxx_std_20)
target_compile_options(furrow_options INTERFACE -Wall -Wextra -Wpedantic -fno-math-errno -fno-trapping-math)
# GCC collects its garbage from 128 MB on; a tenth of a build's time goes there. A compiler still stays below 1.5 GB.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(furrow_options INTERFACE --param=ggc-min-heapsize=262144)
endif()
# GCC 12 to 14 warn of overlaps and overflows inside std::string and std::vector where there are none (GCC bug 105651
# and the like), and of uninitialized vectors inside its own AVX-512 header (GCC bug 105593); the sanitizers look for
# real ones.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 15)
  target_compile_options(furrow_options INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
    -Wno-stringop-overread -Wno-maybe-uninitialized -Wno-uninitialized)
endif()
target_compile_definitions(furrow_interface INTERFACE EIGEN_DONT_PARALLELIZE)
# Eigen's alignment, and with it the layout of every class that holds an Eigen type, follows the instruction
# set. It is pinned so that objects built with and without -march=native can be linked together.
# So is the alignment of what it allocates: it decides whether memory is freed by free() or by Eigen's own means.
target_compile_definitions(furrow_interface INTERFACE EIGEN_MAX_STATIC_ALIGN_BYTES=16 EIGEN_MAX_ALIGN_BYTES=64)
target_link_libraries(furrow_interface INTERFACE Eigen3::Eigen fmt::fmt OpenMP::OpenMP_CXX Threads::Threads)
if(FURROW_NATIVE)
  target_compile_options(furrow_options INTERFACE -march=native)
elseif(NOT FURROW_LEVEL STREQUAL "any")
  target_compile_options(furrow_options INTERFACE -march=${FURROW_LEVEL})
endif()
if(FURROW_WERROR)
  target_compile_options(furrow_options INTERFACE -Werror)
endif()
if(FURROW_SANITIZE)
  target_compile_options(furrow_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer -g)
  target_link_options(furrow_options INTERFACE -fsanitize=address,undefined)
endif()

# libFuzzer's targets need instrumented libraries, and their coverage can be measured afterwards (tests/fuzz).
if(FURROW_FUZZ)
  target_compile_options(furrow_options INTERFACE -gline-tables-only -O1 -fno-omit-frame-pointer
    -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fprofile-instr-generate
    -fcoverage-mapping)
  target_link_options(furrow_options INTERFACE -fsanitize=address,undefined -fprofile-instr-generate)
endif()

# furrow_arithmetic(<variable>): a digest of what decides the bits of results besides the sources: the macros that the
# compiler defines for its version, target and tuning, and its options of the kinds -f, -m and -O.
function(furrow_arithmetic variable)
  get_target_property(options furrow_options INTERFACE_COMPILE_OPTIONS)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  separate_arguments(given NATIVE_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
  set(options ${given} ${options})
  list(FILTER options INCLUDE REGEX "^-[fmO]")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${options} -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros ERROR_QUIET)
  string(SHA256 digest "${options} ${macros}")
  string(SUBSTRING ${digest} 0 16 digest)
  set(${variable} ${digest} PARENT_SCOPE)
endfunction()

# Precompiled headers save a third of the build. Sources include what they use all the same:
# scripts/check_headers.py checks it.
if(FURROW_PCH)
  set(_headers <Eigen/Core> <Eigen/Geometry> <algorithm> <filesystem> <functional> <memory> <span> <string> <vector>
    <fmt/format.h> <nlohmann/json.hpp>)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp
    CONTENT "// Only there to compile the precompiled headers.\n")
endif()

# Flags of code whose speed does not count: it compiles in half of the time. Physics and its loops stay at -O3.
set(FURROW_QUICK $<$<CONFIG:Release,RelWithDebInfo>:-Og>)

# furrow_compile(<target> <name> [HEADERS <file>…] [FLAGS <flag>…] [LIBS <target>…]): compiles a target with these flags
# and with the precompiled headers <name>, which are made with the same flags and libraries where they are first asked
# for: under other flags the compiler would pass them over.
function(furrow_compile target name)
  cmake_parse_arguments(ARG "" "" "HEADERS;FLAGS;LIBS" ${ARGN})
  target_compile_options(${target} PRIVATE ${ARG_FLAGS})
  if(NOT FURROW_PCH)
    return()
  endif()
  if(NOT TARGET ${name})
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_link_libraries(${name} PRIVATE furrow_options ${ARG_LIBS})
    target_compile_options(${name} PRIVATE ${ARG_FLAGS})
    target_precompile_headers(${name} PRIVATE ${_headers} ${ARG_HEADERS})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()

# furrow_targets(<variable> <types> <folder>...): the targets of these types, separated by |, that are made there.
function(furrow_targets variable types)
  set(found)
  foreach(folder ${ARGN})
    get_directory_property(targets DIRECTORY ${folder} BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
      get_target_property(type ${target} TYPE)
      if(type MATCHES "^(${types})$")
        list(APPEND found ${target})
      endif()
    endforeach()
  endforeach()
  set(${variable} ${found} PARENT_SCOPE)
endfunction()

# furrow_precompile(<folder>...): lets the libraries and programs made in these folders use the precompiled headers,
# but for those that use others already.
function(furrow_precompile)
  furrow_targets(targets "STATIC_LIBRARY|OBJECT_LIBRARY|EXECUTABLE" ${ARGN})
  list(REMOVE_ITEM targets furrow_cpu_check)
  foreach(target ${targets})
    get_target_property(others ${target} PRECOMPILE_HEADERS_REUSE_FROM)
    get_target_property(own ${target} PRECOMPILE_HEADERS)
    if(NOT others AND NOT own)
      furrow_compile(${target} furrow_pch)
    endif()
  endforeach()
endfunction()

# furrow_quick(<target>...): compiles these libraries and programs with FURROW_QUICK.
function(furrow_quick)
  foreach(target ${ARGN})
    furrow_compile(${target} furrow_quick_pch FLAGS ${FURROW_QUICK})
  endforeach()
endfunction()

# furrow_quick_parts(<library> <source or folder>…): compiles these parts of a library with FURROW_QUICK, folder by
# folder, as a library of objects in it. To be called where the library is made, after its links.
function(furrow_quick_parts library)
  get_target_property(sources ${library} SOURCES)
  list(JOIN ARGN "|" parts)
  set(quick ${sources})
  list(FILTER quick INCLUDE REGEX "^(${parts})(/|$)")
  list(REMOVE_ITEM sources ${quick})
  set_property(TARGET ${library} PROPERTY SOURCES ${sources} $<TARGET_OBJECTS:${library}_quick>)
  add_library(${library}_quick OBJECT ${quick})
  get_target_property(links ${library} LINK_LIBRARIES)
  get_target_property(definitions ${library} COMPILE_DEFINITIONS)
  target_link_libraries(${library}_quick PRIVATE ${links})
  if(definitions)
    target_compile_definitions(${library}_quick PRIVATE ${definitions})
  endif()
  furrow_batch_folders(${library}_quick)
  furrow_compile(${library}_quick furrow_quick_pch FLAGS ${FURROW_QUICK})
endfunction()

# furrow_batch(<folder>...): compiles the sources of the libraries of these folders sixteen at a time, in a third of the
# time. Names in anonymous namespaces must differ within a library. FURROW_BATCH=OFF compiles each source alone.
function(furrow_batch)
  if(NOT FURROW_BATCH)
    return()
  endif()
  furrow_targets(targets STATIC_LIBRARY ${ARGN})
  set_target_properties(${targets} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
endfunction()

# furrow_batch_folders(<library> [<folder>…]): compiles the sources of each of these folders of a library together, in a
# third of the time; `.` are those without a folder. Without folders it does so for all. Names in anonymous namespaces
# must differ within a folder. To be called where the library is made.
function(furrow_batch_folders library)
  if(NOT FURROW_BATCH)
    return()
  endif()
  get_target_property(sources ${library} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ./${source} DIRECTORY)
    string(REGEX REPLACE "^\\./" "" folder ${folder})
    if(NOT ARGN OR folder IN_LIST ARGN)
      string(MAKE_C_IDENTIFIER ${folder} group)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
    endif()
  endforeach()
  set_target_properties(${library} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# furrow_test(<name> LABELS <label>… LIBS <target>… SOURCES <file>… [TIMEOUT <s>]): one GoogleTest program, one CTest
# entry. The target tests_<label> builds all programs with that label. The sources of a program are compiled together,
# which takes less than half of the time.
function(furrow_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "LABELS;LIBS;SOURCES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  target_link_libraries(${name} PRIVATE furrow_options ${ARG_LIBS} GTest::gtest GTest::gtest_main)
  furrow_compile(${name} furrow_test_pch HEADERS <gtest/gtest.h> FLAGS ${FURROW_QUICK} LIBS GTest::gtest)
  add_test(NAME ${name} COMMAND ${name})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)  # finds what hangs, however busy the machine is
  endif()
  if(FURROW_SANITIZE)  # ten times slower
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  # Threads that wait would spin, and other tests run beside this one.
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT}
    ENVIRONMENT_MODIFICATION OMP_WAIT_POLICY=set:passive)
  foreach(label ${ARG_LABELS})
    if(NOT TARGET tests_${label})
      add_custom_target(tests_${label})
    endif()
    add_dependencies(tests_${label} ${name})
  endforeach()
endfunction()
