# SPDX-License-Identifier: Apache-2.0
# What the shared library offers is what was written down: a symbol that goes is found, and one that
# comes unasked.
#   cmake -D NM=<nm> -D LIBRARY=<file> -D GOLDEN=<file> -P symbols.cmake
cmake_policy(VERSION 3.25)
execute_process(COMMAND ${NM} -D --defined-only --format=posix ${LIBRARY}
  OUTPUT_VARIABLE listing RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "the symbols of ${LIBRARY} cannot be listed")
endif()
string(REGEX MATCHALL "[^\n]+" lines "${listing}")
set(symbols)
foreach(line IN LISTS lines)
  string(REGEX REPLACE " .*" "" symbol "${line}")
  # The nm of clang has a version as a symbol of itself.
  string(REGEX REPLACE "^(RR_[0-9]+)@@RR_[0-9]+$" "\\1" symbol "${symbol}")
  list(APPEND symbols "${symbol}")
endforeach()
list(SORT symbols)
list(JOIN symbols "\n" text)
if("$ENV{ROBDEF_UPDATE}" STREQUAL "symbols")
  file(WRITE "${GOLDEN}" "${text}\n")
endif()
file(READ "${GOLDEN}" golden)
if(NOT golden STREQUAL "${text}\n")
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/symbols.txt" "${text}\n")
  message(FATAL_ERROR "symbols other than in ${GOLDEN}: see symbols.txt in the build folder; "
                      "ROBDEF_UPDATE=symbols takes them over")
endif()
