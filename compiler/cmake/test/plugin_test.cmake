# SPDX-License-Identifier: Apache-2.0
# Builds the project in plugin/ twice: with the plug-in as it is, and edited.
#   cmake -D SOURCE= -D MODULE= -D ROBDEF= -D SCRATCH= -P plugin_test.cmake
file(REMOVE_RECURSE "${SCRATCH}")
file(COPY "${SOURCE}/" DESTINATION "${SCRATCH}/source")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${said}")
  endif()
endfunction()

function(expect text)
  file(READ "${SCRATCH}/build/pages/options.txt" made)
  if(NOT made STREQUAL text)
    message(FATAL_ERROR "made: ${made}")
  endif()
endfunction()

run(${CMAKE_COMMAND} -G Ninja -S "${SCRATCH}/source" -B "${SCRATCH}/build"
    "-DROBDEF=${ROBDEF}" "-DMODULE=${MODULE}")
run(${CMAKE_COMMAND} --build "${SCRATCH}/build")
expect("first \"a\":\"1\",\"b\":\"2 3\"")

execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 0.05)
file(READ "${SCRATCH}/source/names.sh" script)
string(REPLACE "first" "second" script "${script}")
file(WRITE "${SCRATCH}/source/names.sh" "${script}")
run(${CMAKE_COMMAND} --build "${SCRATCH}/build")
expect("second \"a\":\"1\",\"b\":\"2 3\"")
file(REMOVE_RECURSE "${SCRATCH}")
