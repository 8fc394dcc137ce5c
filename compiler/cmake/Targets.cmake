# SPDX-License-Identifier: Apache-2.0
# What every target of this tree has in common: language level, warnings, where programs land, and
# how a test is declared.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# What goes into no shared library is smaller and compiles faster without.
if(ROBDEF_COMPILER_ONLY)
  set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
else()
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
# g++ looks for memory to free each time that it has grown twofold: to do so less often saves a tenth of the time
# (docs/project/measurements.md). Not for sanitizers, whose code takes twice the memory.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize|ggc-min-expand")
  string(PREPEND CMAKE_CXX_FLAGS "--param=ggc-min-expand=300 ")
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

find_program(ROBDEF_CCACHE ccache)
if(ROBDEF_CCACHE)
  # Without the first it does not keep what was compiled with a precompiled header. With the others
  # several checkouts share what they compile alike.
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${ROBDEF_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
endif()

# The address sanitizer of clang is a shared library, as that of g++ is, and found beside the compiler only.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=address")
  set(library libasan.so)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(library libclang_rt.asan-${CMAKE_SYSTEM_PROCESSOR}.so)
  endif()
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${library}
    OUTPUT_VARIABLE ROBDEF_LIBASAN OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    cmake_path(GET ROBDEF_LIBASAN PARENT_PATH folder)
    add_link_options(-Wl,-rpath,${folder})
  endif()
endif()

find_package(Threads REQUIRED)

# robdef_unity(TARGET SOURCES)
# Compiles so many sources of a target at once, where ROBDEF_UNITY says so: 0 for all. Not for what users link: their
# programs get whole object files.
function(robdef_unity target sources)
  if(ROBDEF_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${sources})
  endif()
endfunction()

# robdef_together(TARGET NAME SOURCES)
# Compiles sources of a folder, named without .cpp, as one in a release: what is called for each message is
# inlined then. For classes and functions that a program is linked with all of or none of.
function(robdef_together target name)
  if(CMAKE_BUILD_TYPE STREQUAL "Release" OR ROBDEF_UNITY)
    list(TRANSFORM ARGN APPEND .cpp OUTPUT_VARIABLE sources)
    set_source_files_properties(${sources} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
endfunction()

# robdef_tables_first(LIST)
# Puts the sources first that specialize a template, which has to come before its uses.
macro(robdef_tables_first list)
  set(tables ${${list}})
  list(FILTER tables INCLUDE REGEX "view_tables\\.cpp$")
  list(REMOVE_ITEM ${list} ${tables})
  list(PREPEND ${list} ${tables})
endmacro()

# robdef_joint(NAME FOLDERS...)
# A static library of FOLDERS, libraries that robdef_library() declares after it: their sources are compiled as one, so
# that headers are read and templates made once. Each of them is a name that leads to it.
function(robdef_joint name)
  add_library(${name} STATIC)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} PRIVATE robdef_warnings)
  # A program gets the functions that it uses, not all folders.
  target_compile_options(${name} PRIVATE -ffunction-sections -fdata-sections)
  robdef_unity(${name} 0)
  foreach(folder IN LISTS ARGN)
    set_property(GLOBAL PROPERTY ROBDEF_JOINT_OF_${folder} ${name})
  endforeach()
endfunction()

# robdef_compiled_in(VARIABLE LIBRARY)
# The target that compiles the sources of a library: itself, or the one that it is a part of.
function(robdef_compiled_in variable library)
  get_property(joint GLOBAL PROPERTY ROBDEF_JOINT_OF_${library})
  if(NOT joint)
    set(joint ${library})
  endif()
  set(${variable} ${joint} PARENT_SCOPE)
endfunction()

# robdef_join(JOINT NAME SOURCES... [DEPENDS targets...])
# robdef_library(NAME) as a part of JOINT.
function(robdef_join joint name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SOURCES;DEPENDS")
  get_target_property(all ${joint} SOURCES)
  if(NOT all)
    set(all "")
  endif()
  foreach(source IN LISTS arg_SOURCES)
    cmake_path(ABSOLUTE_PATH source)
    list(APPEND all ${source})
  endforeach()
  robdef_tables_first(all)
  set_target_properties(${joint} PROPERTIES SOURCES "${all}")
  foreach(target IN LISTS arg_DEPENDS)
    robdef_compiled_in(home ${target})
    if(NOT home STREQUAL joint)
      target_link_libraries(${joint} PUBLIC ${target})
    endif()
  endforeach()
  add_library(${name} INTERFACE)
  target_link_libraries(${name} INTERFACE ${joint})
endfunction()

set(robdef_standard_headers
  algorithm array atomic charconv chrono condition_variable cstdint cstring deque exception functional future
  limits map memory mutex optional set span string string_view thread utility variant vector)

# robdef_headers(PREFIX)
# What libraries and tests of this folder and those below have precompiled, where ROBDEF_UNITY says so:
# headers of the standard library, and those of GoogleTest. One of each for all, as their flags are the same.
# Not for the compiler: it has names that <iomanip> has too, which others of these bring.
macro(robdef_headers prefix)
  if(ROBDEF_UNITY)
    set(ROBDEF_LIBRARY_HEADERS ${prefix}_library_headers)
    set(ROBDEF_TEST_HEADERS ${prefix}_test_headers)
    robdef_make_headers()
  endif()
endmacro()
function(robdef_make_headers)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
  list(TRANSFORM robdef_standard_headers REPLACE "(.+)" "<\\1>" OUTPUT_VARIABLE headers)
  add_library(${ROBDEF_LIBRARY_HEADERS} OBJECT ${source})
  target_link_libraries(${ROBDEF_LIBRARY_HEADERS} PRIVATE robdef_warnings)
  target_precompile_headers(${ROBDEF_LIBRARY_HEADERS} PRIVATE ${headers})
  if(ROBDEF_TESTS)
    add_executable(${ROBDEF_TEST_HEADERS} ${source})
    target_link_libraries(${ROBDEF_TEST_HEADERS} PRIVATE robdef_warnings GTest::gmock)
    target_compile_options(${ROBDEF_TEST_HEADERS} PRIVATE -O0)
    target_precompile_headers(${ROBDEF_TEST_HEADERS} PRIVATE ${headers} <gmock/gmock.h> <gtest/gtest.h>)
  endif()
endfunction()

# robdef_precompiled(TARGET [HEADERS])
# The target has these headers precompiled, or those of libraries; not one with sources in C.
function(robdef_precompiled target)
  set(headers ${ROBDEF_LIBRARY_HEADERS} ${ARGN})
  get_target_property(sources ${target} SOURCES)
  if(headers AND NOT sources MATCHES "\\.c(;|$)")
    list(POP_BACK headers last)
    target_precompile_headers(${target} REUSE_FROM ${last})
    # g++ forgets which code is of a system's header when that is precompiled, and warns of it.
    target_compile_options(${target} PRIVATE
      "$<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-array-bounds>")
  endif()
endfunction()

# Warnings for our own sources and for generated code alike.
add_library(robdef_warnings INTERFACE)
target_compile_options(robdef_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion
  # Of sources that are compiled at once, a local name may be one of another's.
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>
  # g++ 12 sees overlapping copies in `"text" + std::string()` (its bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  # Which lock guards what (rr/mutex.hpp); a finding is never let pass.
  $<$<CXX_COMPILER_ID:Clang>:-Wthread-safety;-Wthread-safety-beta;-Werror=thread-safety>
  $<$<BOOL:${ROBDEF_WERROR}>:-Werror>)

# robdef_library(NAME SOURCES... [DEPENDS targets...])
# A static library of one folder, or a part of a joint one. Includes are written from the root of the tree.
function(robdef_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
  robdef_compiled_in(joint ${name})
  if(NOT joint STREQUAL name)
    robdef_join(${joint} ${name} SOURCES ${arg_SOURCES} DEPENDS ${arg_DEPENDS})
    return()
  endif()
  robdef_tables_first(arg_SOURCES)
  add_library(${name} STATIC ${arg_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} PRIVATE robdef_warnings PUBLIC ${arg_DEPENDS})
  if(arg_SOURCES)
    robdef_unity(${name} 0)
    robdef_precompiled(${name})
  endif()
endfunction()

# robdef_test(NAME SOURCES... [DEPENDS targets...] [ENVIRONMENT KEY=VALUE...] [COST seconds] [PARTS number] [SERIAL])
# A GoogleTest program. Tests that take long say so by their COST, as others do with the property: CTest begins with them.
# Tests that measure times run alone: SERIAL.
# CTest has each of its tests, with the label `single`, and the program in PARTS (1), with the label `whole`, which are the
# same tests: most of them are shorter than the start of their program. The presets for tests run those one by one, `./check`
# these. Under a sanitizer, where programs take longest to start and to end, there are only these.
function(robdef_test name)
  if(NOT ROBDEF_TESTS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "SERIAL" "COST;PARTS" "SOURCES;DEPENDS;ENVIRONMENT")
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE robdef_warnings ${arg_DEPENDS} GTest::gmock GTest::gtest_main)
  robdef_unity(${name} 6)
  # What is tested is optimized; the tests need not be, and compile much faster.
  target_compile_options(${name} PRIVATE -O0)
  robdef_precompiled(${name} ${ROBDEF_TEST_HEADERS})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  set(cost "")
  if(arg_COST)
    set(cost COST ${arg_COST})
  endif()
  if(arg_SERIAL)
    list(APPEND cost RUN_SERIAL ON)
  endif()
  robdef_add_parts(${name} "${arg_PARTS}" TIMEOUT 1800 ${cost})
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    include(GoogleTest)
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
      PROPERTIES TIMEOUT 120 LABELS single ENVIRONMENT "${arg_ENVIRONMENT}" ${cost})
  endif()
endfunction()
# For robdef_test(), whose arg_ENVIRONMENT it reads.
function(robdef_add_parts name count)
  if(NOT count)
    set(count 1)
  endif()
  math(EXPR last "${count} - 1")
  foreach(index RANGE ${last})
    set(part ${name}.part_${index})
    add_test(NAME ${part} COMMAND ${name})
    set_tests_properties(${part} PROPERTIES ${ARGN} LABELS whole
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${count};GTEST_SHARD_INDEX=${index};${arg_ENVIRONMENT}")
  endforeach()
endfunction()

# For programs of .NET that load a library of this build: the address sanitizer must be loaded first, and leaves faults and
# what .NET keeps at its end to .NET.
set(robdef_managed_environment "")
if(ROBDEF_LIBASAN)
  set(robdef_managed_environment "LD_PRELOAD=${ROBDEF_LIBASAN};ASAN_OPTIONS=detect_leaks=0:handle_segv=0:exitcode=99")
endif()
# .NET's own threads, of which the thread sanitizer sees nothing, would be reported as faults: its tests are left out.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
  set(ROBDEF_DOTNET "" CACHE FILEPATH ".NET for tests" FORCE)
endif()

# robdef_fuzzer(NAME SOURCES... SEEDS folders... [DEPENDS targets...])
# A libFuzzer program; `./check --long` runs each from the folders of its seeds.
function(robdef_fuzzer name)
  if(NOT ROBDEF_FUZZERS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS;SEEDS")
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE robdef_warnings ${arg_DEPENDS})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  list(TRANSFORM arg_SEEDS PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  list(JOIN arg_SEEDS " " seeds)
  set_property(GLOBAL APPEND_STRING PROPERTY ROBDEF_FUZZER_LIST "$<TARGET_FILE:${name}> ${seeds}\n")
endfunction()
