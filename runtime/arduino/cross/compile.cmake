# SPDX-License-Identifier: Apache-2.0
# Compiles the library and sketches for a board whose core is not here, and compares their sizes with sizes.txt.
# Functions of the core and of the C library are declared only, so what is measured is the library, the sketch and
# what the compiler adds, for floating point above all.
#   BOARD           samd, rp2040 or esp8266
#   PREFIX          of the compiler's programs: /usr/bin/arm-none-eabi-
#   SOURCE_DIR      runtime/arduino
#   FOLDER          scratch
#   SKETCHES        folders with a sketch of their name
#   DEFINITIONS     folders with generated headers
cmake_minimum_required(VERSION 3.25)
set(tolerance 5)  # percent
set(common -Os -Wall -Wextra -Werror -fno-exceptions -fno-rtti -fno-threadsafe-statics
  -ffunction-sections -fdata-sections -ffreestanding -nostdlib)
# Language and processor as the cores have them.
set(flags_samd -std=gnu++11 -mcpu=cortex-m0plus -mthumb -DARDUINO_ARCH_SAMD)
set(flags_rp2040 -std=gnu++17 -mcpu=cortex-m0plus -mthumb -DARDUINO_ARCH_RP2040)
set(flags_esp8266 -std=gnu++17 -mlongcalls -mtext-section-literals -DARDUINO_ARCH_ESP8266 -DESP8266)
set(flags ${common} ${flags_${BOARD}} -DARDUINO=10819
  -I${SOURCE_DIR}/cross/core -I${SOURCE_DIR}/src)

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
set(findings "")

# compile(SOURCE OBJECT flags...)
function(compile source object)
  execute_process(COMMAND ${PREFIX}g++ ${flags} ${ARGN} -c ${source} -o ${FOLDER}/${object}
    RESULT_VARIABLE status ERROR_VARIABLE error)
  if(status)
    message(FATAL_ERROR "${source} does not compile for ${BOARD}:\n${error}")
  endif()
endfunction()

file(GLOB library ${SOURCE_DIR}/src/rr/*.cpp)
set(objects "")
foreach(source IN LISTS library ITEMS ${SOURCE_DIR}/cross/core/main.cpp)
  get_filename_component(name ${source} NAME_WE)
  compile(${source} ${name}.o)
  list(APPEND objects ${FOLDER}/${name}.o)
endforeach()

string(REPLACE "|" ";" SKETCHES "${SKETCHES}")
foreach(folder IN LISTS SKETCHES)
  get_filename_component(name ${folder} NAME)
  compile(${folder}/${name}.ino ${name}.ino.o -x c++ -include Arduino.h -I${folder})
  execute_process(COMMAND ${PREFIX}g++ ${flags_${BOARD}} -nostdlib -Wl,--gc-sections -Wl,-e,main
      -Wl,--unresolved-symbols=ignore-all ${FOLDER}/${name}.ino.o ${objects} -lgcc -o ${FOLDER}/${name}.elf
    RESULT_VARIABLE status ERROR_VARIABLE error)
  if(status)
    message(FATAL_ERROR "${name} is not linked for ${BOARD}:\n${error}")
  endif()
  execute_process(COMMAND ${PREFIX}size ${FOLDER}/${name}.elf OUTPUT_VARIABLE out
    COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "\n *([0-9]+)[ \t]+([0-9]+)[ \t]+([0-9]+)" found "${out}")
  math(EXPR flash "${CMAKE_MATCH_1} + ${CMAKE_MATCH_2}")
  math(EXPR ram "${CMAKE_MATCH_2} + ${CMAKE_MATCH_3}")
  message("${BOARD} ${name}: ${flash} bytes of flash, ${ram} of RAM, without the core")
  file(STRINGS ${SOURCE_DIR}/cross/sizes.txt line REGEX "^${BOARD} ${name} ")
  string(REGEX MATCHALL "[^ ]+" words "${line}")
  list(LENGTH words count)
  if(NOT count EQUAL 4)
    list(APPEND findings "sizes.txt has no row `${BOARD} ${name} FLASH RAM`")
    continue()
  endif()
  list(GET words 2 flash_golden)
  list(GET words 3 ram_golden)
  foreach(kind IN ITEMS flash ram)
    math(EXPR low "${${kind}_golden} * (100 - ${tolerance}) / 100 - 8")
    math(EXPR high "${${kind}_golden} * (100 + ${tolerance}) / 100 + 8")
    if(${kind} LESS low OR ${kind} GREATER high)
      list(APPEND findings "${name}: ${kind} is ${${kind}}, sizes.txt says ${${kind}_golden}")
    endif()
  endforeach()
endforeach()
if(findings)
  list(JOIN findings "\n" text)
  message(FATAL_ERROR "${text}")
endif()
