# SPDX-License-Identifier: Apache-2.0
# Configures the project in subproject/: it gets no tests, no examples, and no warnings as errors.
#   cmake -D SOURCE= -D ROBDEF_TREE= -D COMPILER= -D SCRATCH= -P subproject_test.cmake
file(REMOVE_RECURSE "${SCRATCH}")
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S "${SOURCE}" -B "${SCRATCH}"
    "-DROBDEF_TREE=${ROBDEF_TREE}" "-DCMAKE_CXX_COMPILER=${COMPILER}"
  RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "configuring: ${said}")
endif()
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir "${SCRATCH}" -N OUTPUT_VARIABLE tests ERROR_VARIABLE tests)
if(NOT tests MATCHES "Total Tests: 0" AND NOT tests MATCHES "No tests were found")
  message(FATAL_ERROR "there are tests: ${tests}")
endif()
file(READ "${SCRATCH}/build.ninja" rules)
# The ANTLR tool has such an option, too.
string(REPLACE "-Werror -Dlanguage" "" rules "${rules}")
foreach(word IN ITEMS "-Werror" "smart_room" "cmake_object_order_depends_target_syntax_test")
  string(FIND "${rules}" "${word}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${word} is in build.ninja")
  endif()
endforeach()
file(REMOVE_RECURSE "${SCRATCH}")
