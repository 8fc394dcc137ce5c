# SPDX-License-Identifier: Apache-2.0
# Builds the project SOURCE against a robdef package, then edits its definitions and looks at what
# is generated and compiled again. Copies everything into SCRATCH.
#   PACKAGE       folder of robdefConfig.cmake; or
#   INSTALL_FROM  a build folder that is installed into SCRATCH first
#   GENERATOR, COMPILER, FLAGS

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE "${SCRATCH}")
file(COPY "${SOURCE}/" DESTINATION "${SCRATCH}/source")
if(INSTALL_FROM)
  run(${CMAKE_COMMAND} --install "${INSTALL_FROM}" --prefix "${SCRATCH}/prefix")
  foreach(installed bin/robdef include/rr/error.hpp include/rr.h include/rr_c/values.h share/man/man1/robdef.1
                    share/bash-completion/completions/robdef include/rr/realtime/service.hpp
                    share/robdef/cbus/rr_bus.c)
    if(NOT EXISTS "${SCRATCH}/prefix/${installed}")
      message(SEND_ERROR "not installed: ${installed}")
    endif()
  endforeach()
  set(found "-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix")
else()
  set(found "-Drobdef_DIR=${PACKAGE}")
endif()
set(build "${SCRATCH}/build")
run(${CMAKE_COMMAND} -G "${GENERATOR}" -S "${SCRATCH}/source" -B "${build}" ${found}
    -D CMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" -D CMAKE_BUILD_TYPE=Debug)

set(generated "${build}/definitions_robdef/example")
set(stamps "${build}/definitions_robdef.stamps")
set(objects "${build}/CMakeFiles/definitions.dir/definitions_robdef/example")
set(watched
  "base command=${stamps}/example.base.robdef.stamp"
  "mount command=${stamps}/example.mount.robdef.stamp"
  "other command=${stamps}/example.other.robdef.stamp"
  "base header=${generated}/base.hpp"
  "mount header=${generated}/mount.hpp"
  "other header=${generated}/other.hpp"
  "base object=${objects}/base.cpp.o"
  "mount object=${objects}/mount.cpp.o"
  "other object=${objects}/other.cpp.o"
  "main object=${build}/CMakeFiles/consumer.dir/main.cpp.o")

# Builds, and sets `result` to the names of the watched files that are new.
function(build_and_watch result)
  foreach(entry IN LISTS watched)
    string(REGEX MATCH "^([^=]*)=(.*)$" entry "${entry}")
    file(TIMESTAMP "${CMAKE_MATCH_2}" "before_${CMAKE_MATCH_1}" "%s.%f")
  endforeach()
  run(${CMAKE_COMMAND} --build "${build}" --parallel 2)
  set(changed "")
  foreach(entry IN LISTS watched)
    string(REGEX MATCH "^([^=]*)=(.*)$" entry "${entry}")
    set(name "${CMAKE_MATCH_1}")
    file(TIMESTAMP "${CMAKE_MATCH_2}" after "%s.%f")
    if(after STREQUAL "")
      message(FATAL_ERROR "was not made: ${CMAKE_MATCH_2}")
    endif()
    if(NOT after STREQUAL "${before_${name}}")
      list(APPEND changed "${name}")
    endif()
  endforeach()
  set(${result} "${changed}" PARENT_SCOPE)
endfunction()

function(expect changed what)
  list(JOIN changed ", " changed)
  list(JOIN ARGN ", " expected)
  if(NOT changed STREQUAL expected)
    message(SEND_ERROR "${what}\n  there are: ${changed}\n  expected:  ${expected}")
  endif()
endfunction()

# Make compares times of whole milliseconds on some file systems.
function(edit file from to)
  execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 0.05)
  file(READ "${SCRATCH}/source/${file}" text)
  string(REPLACE "${from}" "${to}" text "${text}")
  file(WRITE "${SCRATCH}/source/${file}" "${text}")
endfunction()

build_and_watch(changed)
# The names that CMake derived are exactly those that were generated.
file(GLOB_RECURSE files RELATIVE "${generated}" "${generated}/*")
list(SORT files)
expect("${files}" "generated files" base.cpp base.hpp mount.cpp mount.hpp other.cpp other.hpp)
execute_process(COMMAND "${build}/consumer" OUTPUT_VARIABLE said)
if(NOT said STREQUAL "pan 0.25, number 7\n")
  message(SEND_ERROR "the program said: ${said}")
endif()

build_and_watch(changed)
expect("${changed}" "nothing was edited")

edit(shared/example.base.robdef "" "")
build_and_watch(changed)
expect("${changed}" "an import was touched: its readers run again, and write nothing"
  "base command" "mount command")

build_and_watch(changed)
expect("${changed}" "nothing was edited after that")

edit(shared/example.base.robdef "    field double tilt\n" "    field double tilt\n    field double roll\n")
build_and_watch(changed)
expect("${changed}" "an import has a new field: what includes its header is compiled again"
  "base command" "mount command" "base header" "base object" "mount object" "main object")

edit(definitions/example.other.robdef "field int32 number" "field int64 number")
build_and_watch(changed)
expect("${changed}" "an independent definition was edited"
  "other command" "other header" "other object" "main object")

file(REMOVE_RECURSE "${SCRATCH}")
