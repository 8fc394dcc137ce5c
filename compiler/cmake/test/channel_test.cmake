# SPDX-License-Identifier: Apache-2.0
# Builds the project SOURCE, which brings a channel of its own, against the robdef package that
# INSTALL_FROM installs into SCRATCH, and runs it. GENERATOR, COMPILER, FLAGS as in package_test.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE "${SCRATCH}")
run(${CMAKE_COMMAND} --install "${INSTALL_FROM}" --prefix "${SCRATCH}/prefix")
run(${CMAKE_COMMAND} -G "${GENERATOR}" -S "${SOURCE}" -B "${SCRATCH}/build"
    "-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix" -D CMAKE_CXX_COMPILER=${COMPILER}
    "-DCMAKE_CXX_FLAGS=${FLAGS}" -D CMAKE_BUILD_TYPE=Debug)
run(${CMAKE_COMMAND} --build "${SCRATCH}/build" --parallel 2)
execute_process(COMMAND "${SCRATCH}/build/packets" OUTPUT_VARIABLE said ERROR_VARIABLE said TIMEOUT 60)
if(NOT said STREQUAL "height 0.25, echo same, moved 1.5, too large: RobotRaconteur.ProtocolError\n")
  message(SEND_ERROR "the program said: ${said}")
endif()
file(REMOVE_RECURSE "${SCRATCH}")
