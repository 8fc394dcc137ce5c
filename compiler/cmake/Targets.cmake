# SPDX-License-Identifier: Apache-2.0
# What every target of this tree has in common: language level, warnings, where programs land, and
# how a test is declared.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

find_program(ROBDEF_CCACHE ccache)
if(ROBDEF_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ROBDEF_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${ROBDEF_CCACHE})
endif()

find_package(Threads REQUIRED)

# robdef_unity(TARGET)
# Compiles several sources of a target at once, where ROBDEF_UNITY says so. Not for what users link: their
# programs get whole object files.
function(robdef_unity target)
  if(ROBDEF_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
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
  $<$<BOOL:${ROBDEF_WERROR}>:-Werror>)

# robdef_library(NAME SOURCES... [DEPENDS targets...])
# A static library of one folder. Includes are written from the root of the tree.
function(robdef_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
  add_library(${name} STATIC ${arg_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} PRIVATE robdef_warnings PUBLIC ${arg_DEPENDS})
  if(arg_SOURCES)
    robdef_unity(${name})
  endif()
endfunction()

# robdef_test(NAME SOURCES... [DEPENDS targets...] [ENVIRONMENT KEY=VALUE...] [COST seconds])
# A GoogleTest program; each of its tests is a test of CTest. Tests that take long say so by their COST, as
# others do with the property: CTest begins with them.
function(robdef_test name)
  if(NOT ROBDEF_TESTS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "COST" "SOURCES;DEPENDS;ENVIRONMENT")
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE robdef_warnings ${arg_DEPENDS} GTest::gmock GTest::gtest_main)
  robdef_unity(${name})
  # What is tested is optimized; the tests need not be, and compile much faster.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O0>)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  set(cost "")
  if(arg_COST)
    set(cost COST ${arg_COST})
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT 120 ENVIRONMENT "${arg_ENVIRONMENT}" ${cost})
endfunction()

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
