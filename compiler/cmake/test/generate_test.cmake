# SPDX-License-Identifier: Apache-2.0
# Builds the project in generate/: as it is, with an edited definition, and with another name of its service.
#   cmake -D SOURCE= -D MODULE= -D CBUS= -D ROBDEF= -D SCRATCH= -P generate_test.cmake
file(REMOVE_RECURSE "${SCRATCH}")
file(COPY "${SOURCE}/" DESTINATION "${SCRATCH}/source")

function(run result)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  set(${result} "${said}" PARENT_SCOPE)
  set(status "${status}" PARENT_SCOPE)
endfunction()

function(fail what)
  message(FATAL_ERROR "${what}: ${said}")
endfunction()

function(edit from to)
  execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 0.05)
  file(READ "${SCRATCH}/source/lamp.robdef" text)
  string(REPLACE "${from}" "${to}" text "${text}")
  file(WRITE "${SCRATCH}/source/lamp.robdef" "${text}")
endfunction()

run(said ${CMAKE_COMMAND} -G Ninja -S "${SCRATCH}/source" -B "${SCRATCH}/build"
  "-DROBDEF_EXECUTABLE=${ROBDEF}" "-DMODULE=${MODULE}" "-DCBUS=${CBUS}")
if(NOT status EQUAL 0)
  fail("configuring")
endif()
run(said ${CMAKE_COMMAND} --build "${SCRATCH}/build")
file(GLOB classes "${SCRATCH}/build/classes/*.cs")
if(NOT status EQUAL 0 OR NOT EXISTS "${SCRATCH}/build/bus/example_lamp_bus.h" OR NOT classes)
  fail("building")
endif()

edit("field double level" "field double level\n    field double power")
run(said ${CMAKE_COMMAND} --build "${SCRATCH}/build")
file(READ "${SCRATCH}/build/bus/example_lamp_bus.h" header)
if(NOT status EQUAL 0 OR said MATCHES "Re-running CMake" OR NOT header MATCHES "power")
  fail("building with an edited definition")
endif()

edit("example.lamp" "example.light")
run(said ${CMAKE_COMMAND} --build "${SCRATCH}/build")
if(status EQUAL 0 OR NOT said MATCHES "is called[ \n]+`example.light` now; build once[ \n]+more")
  fail("building with another service")
endif()
run(said ${CMAKE_COMMAND} --build "${SCRATCH}/build")
if(NOT status EQUAL 0 OR NOT said MATCHES "Re-running CMake" OR NOT EXISTS "${SCRATCH}/build/bus/example_light_bus.h")
  fail("building once more")
endif()
file(REMOVE_RECURSE "${SCRATCH}")
