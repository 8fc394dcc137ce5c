# SPDX-License-Identifier: Apache-2.0
# robdef_generate(TARGET
#   FILES a.robdef ...        definitions to generate code for; absolute or in the current source folder
#   LANGUAGE cpp              or cbus: C99 for pods as buses; or any other of `robdef generate`
#   [PLUGIN program]          in place of LANGUAGE: a program that makes the files; a path is absolute or in the
#                             current source folder, a name is one along PATH, or a plug-in of CONFIG
#   [PLUGIN_OPTIONS key=value ...]
#   [IMPORT_PATHS dir ...]    where imported definitions are looked for; the folders of FILES and the
#                             environment variable ROBOTRACONTEUR_ROBDEF_PATH are searched too
#   [CONFIG robdef.toml]      project file with renames and levels of warnings; none by default, wherever one is
#   [RUNTIME robdef::core]    what is linked instead of robdef::runtime, which is everything
#   [OUTPUT_DIR dir])         default: <current binary folder>/TARGET_robdef
#
# Generates code while TARGET is built, and adds it to TARGET: the sources, the include folder and
# the runtime, both passed on to what links TARGET. TARGET is a library or program made before.
# For a service a.b.c the header is included as "a/b/c.hpp", of a bus as "a_b_c_bus.h"; a bus stands on
# robdef::cbus and not on the runtime, and what Simulink needs lies beside it. Nothing is generated for imports: give
# them as FILES too, here or in another target that is linked.
#
# With other languages than these two TARGET is a custom target: the files are in OUTPUT_DIR when it is built, and what
# compiles them depends on it. Nothing is linked.
#
# With PLUGIN it is the same: TARGET is a custom target, the plug-in runs once for each definition, and what it makes
# is in OUTPUT_DIR when TARGET is built.
#
# Each definition has a command of its own that knows all files it read, so an edited import runs
# again exactly what depends on it; files whose text stays the same are not touched.
#
# An edited definition configures nothing again. Only a new name of its service does: the build says so and ends, and the
# next one configures.
#
# Works with the target robdef of this tree and with robdef::robdef of an installed package. A program of another place
# is used where the variable ROBDEF_EXECUTABLE names one. A cross build needs one that runs on this machine, and finds it
# in the path.
#
# robdef_generate_matlab(TARGET
#   FILES a.robdef ...        definitions to generate classes for, imports among them
#   [IMPORT_PATHS dir ...]
#   [CONFIG robdef.toml]
#   [OUTPUT_DIR dir])         default: <current binary folder>/TARGET_robdef
#
# Makes the library TARGET: the MEX file rrmex for Octave with the stubs of all FILES compiled in, in
# OUTPUT_DIR, where the package classes are. In the path, that folder comes before the toolbox. Needs
# the target robdef::matlab.

# The name of the service that a file defines.
function(robdef_service_of file result)
  file(READ "${file}" text)
  # The first statement; in front of it may stand blanks and a byte order mark.
  if(NOT text MATCHES "(^|\n)[^A-Za-z0-9_#\n]*service[ \t\r\n\\\\]+([A-Za-z0-9_.]+)")
    message(FATAL_ERROR "${file}: there is no service line")
  endif()
  set(${result} "${CMAKE_MATCH_2}" PARENT_SCOPE)
endfunction()

# Before code is generated: whether names of files still follow from the service line.
#   cmake -D FILE=a.robdef -D KNOWN=file with the name -P RobdefGenerate.cmake
if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  robdef_service_of("${FILE}" service)
  file(READ "${KNOWN}" known)
  if(NOT service STREQUAL known)
    file(WRITE "${KNOWN}" "${service}")
    message(FATAL_ERROR "${FILE}: the service `${known}` is called `${service}` now; build once more")
  endif()
  return()
endif()

# The paths below OUTPUT_DIR that are generated for `service`, as far as a target is made of them. They are known
# before the compiler is built; a test compares them with what is generated.
function(robdef_output_names service language result)
  set(endings "")
  set(separator "/")
  if(language STREQUAL "cpp")
    set(endings .hpp .cpp)
  elseif(language STREQUAL "cbus")
    set(endings _bus.h _bus.c)
    set(separator "_")
  endif()
  string(REPLACE "." "${separator}" path "${service}")
  list(TRANSFORM endings PREPEND "${path}")
  set(${result} "${endings}" PARENT_SCOPE)
endfunction()

# What generates: its command, and what it depends on.
function(robdef_generator result)
  set(is_foreign FALSE)
  if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
    set(is_foreign TRUE)
    find_program(ROBDEF_EXECUTABLE robdef NO_CMAKE_FIND_ROOT_PATH DOC "robdef of the machine that builds")
  endif()
  if(ROBDEF_EXECUTABLE)
    set(${result} "${ROBDEF_EXECUTABLE}" PARENT_SCOPE)
  elseif(is_foreign)
    message(FATAL_ERROR "a cross build needs a robdef that runs here: set ROBDEF_EXECUTABLE (`cmake --preset host` builds one)")
  else()
    set(${result} robdef::robdef PARENT_SCOPE)
  endif()
endfunction()

# What the command line says of the project file. A build reads one only where that is asked for.
function(robdef_config_option file result)
  set(option --no-config)
  if(file)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    set(option --config "${file}")
  endif()
  set(${result} ${option} PARENT_SCOPE)
endfunction()

# What the command line says of a plug-in, and the file that it is, if it is one.
function(robdef_plugin_maker program options arguments files)
  set(found "")
  cmake_path(ABSOLUTE_PATH program BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE OUTPUT_VARIABLE path)
  if(EXISTS "${path}" OR program MATCHES "/")
    set(program "${path}")
    set(found "${path}")
  endif()
  list(TRANSFORM options PREPEND "--plugin-option=")
  set(${arguments} --plugin "${program}" ${options} PARENT_SCOPE)
  set(${files} "${found}" PARENT_SCOPE)
endfunction()

# The service of a file, and the command that ends a build when it is called otherwise.
function(robdef_known_service file known service check)
  robdef_service_of("${file}" name)
  set(before "")
  if(EXISTS "${known}")
    file(READ "${known}" before)
  endif()
  # Its time says when names of files have changed.
  if(NOT name STREQUAL before)
    file(WRITE "${known}" "${name}")
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${known}")
  set(${service} "${name}" PARENT_SCOPE)
  set(${check} COMMAND ${CMAKE_COMMAND} -D "FILE=${file}" -D "KNOWN=${known}"
    -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}" PARENT_SCOPE)
endfunction()

function(robdef_generate target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "CONFIG;LANGUAGE;OUTPUT_DIR;PLUGIN;RUNTIME" "FILES;IMPORT_PATHS;PLUGIN_OPTIONS")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_FILES)
    message(FATAL_ERROR "usage: robdef_generate(TARGET FILES ... LANGUAGE cpp [IMPORT_PATHS ...] [OUTPUT_DIR dir]); not understood: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(arg_PLUGIN AND arg_LANGUAGE)
    message(FATAL_ERROR "robdef_generate: give either LANGUAGE or PLUGIN")
  endif()
  if(NOT TARGET ${target})
    message(FATAL_ERROR "robdef_generate: there is no target ${target}")
  endif()
  if(NOT arg_OUTPUT_DIR)
    set(arg_OUTPUT_DIR "${target}_robdef")
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT_DIR BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE)

  robdef_config_option("${arg_CONFIG}" config)
  set(files "")
  set(folders "")
  foreach(file IN LISTS arg_FILES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND files "${file}")
  endforeach()
  foreach(folder IN LISTS arg_IMPORT_PATHS)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND folders "${folder}")
  endforeach()
  foreach(file IN LISTS files)
    cmake_path(GET file PARENT_PATH folder)
    list(APPEND folders "${folder}")
  endforeach()
  list(REMOVE_DUPLICATES folders)
  list(TRANSFORM folders PREPEND "-I" OUTPUT_VARIABLE search)

  robdef_generator(generator)
  set(is_linked FALSE)
  if(arg_LANGUAGE STREQUAL "cpp" OR arg_LANGUAGE STREQUAL "cbus")
    set(is_linked TRUE)
  endif()
  set(maker --lang "${arg_LANGUAGE}")
  set(maker_files "")
  set(made_by "${arg_LANGUAGE}")
  if(arg_PLUGIN)
    robdef_plugin_maker("${arg_PLUGIN}" "${arg_PLUGIN_OPTIONS}" maker maker_files)
    cmake_path(GET arg_PLUGIN FILENAME made_by)
  endif()

  set(stamps "")
  foreach(file IN LISTS files)
    cmake_path(GET file FILENAME name)
    set(stamp "${CMAKE_CURRENT_BINARY_DIR}/${target}_robdef.stamps/${name}")
    set(names "")
    set(check "")
    if(is_linked)
      robdef_known_service("${file}" "${stamp}.service" service check)
      robdef_output_names("${service}" "${arg_LANGUAGE}" names)
    endif()
    list(TRANSFORM names PREPEND "${arg_OUTPUT_DIR}/" OUTPUT_VARIABLE outputs)
    # The generated files are byproducts, since they keep their old time when their text stays the
    # same; the stamp says when the command last ran.
    add_custom_command(
      OUTPUT "${stamp}.stamp"
      BYPRODUCTS ${outputs}
      ${check}
      COMMAND ${generator} generate ${config} ${maker} -o "${arg_OUTPUT_DIR}" ${search}
              --depfile "${stamp}.d" --depfile-target "${stamp}.stamp" "${file}"
      COMMAND ${CMAKE_COMMAND} -E touch "${stamp}.stamp"
      DEPENDS "${file}" ${maker_files} ${generator}
      DEPFILE "${stamp}.d"
      COMMENT "Generating ${made_by} from ${name}"
      VERBATIM)
    list(APPEND stamps "${stamp}.stamp")
    if(is_linked)
      target_sources(${target} PRIVATE ${outputs})
    endif()
  endforeach()
  file(MAKE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/${target}_robdef.stamps")

  # One target in front of TARGET, so that headers are there before anything includes them.
  get_property(count TARGET ${target} PROPERTY ROBDEF_GENERATE_CALLS)
  math(EXPR count "0${count} + 1")
  set_property(TARGET ${target} PROPERTY ROBDEF_GENERATE_CALLS ${count})
  add_custom_target(${target}_robdef_${count} DEPENDS ${stamps})
  add_dependencies(${target} ${target}_robdef_${count})

  if(NOT is_linked)
    return()
  endif()
  target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${arg_OUTPUT_DIR}>")
  if(arg_LANGUAGE STREQUAL "cpp")
    # A program uses either stubs or skeletons: the linker leaves out the others.
    target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections)
  endif()
  # By property, so that the caller may link in either form of target_link_libraries.
  set(library robdef::runtime)
  if(arg_RUNTIME)
    set(library ${arg_RUNTIME})
  endif()
  if(arg_LANGUAGE STREQUAL "cbus")
    set(library robdef::cbus)
  endif()
  set_property(TARGET ${target} APPEND PROPERTY LINK_LIBRARIES ${library})
  set_property(TARGET ${target} APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${library})
endfunction()

function(robdef_generate_matlab target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "CONFIG;OUTPUT_DIR" "FILES;IMPORT_PATHS")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_FILES)
    message(FATAL_ERROR "usage: robdef_generate_matlab(TARGET FILES ... [IMPORT_PATHS ...] [OUTPUT_DIR dir]); not understood: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_OUTPUT_DIR)
    set(arg_OUTPUT_DIR "${target}_robdef")
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT_DIR BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE)

  robdef_config_option("${arg_CONFIG}" config)
  set(files "")
  set(search "")
  set(checks "")
  robdef_generator(generator)
  set(client "${arg_OUTPUT_DIR}/client")
  set(outputs "${client}/client.cpp")
  foreach(folder IN LISTS arg_IMPORT_PATHS)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND search "-I${folder}")
  endforeach()
  foreach(file IN LISTS arg_FILES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND files "${file}")
    cmake_path(GET file FILENAME name)
    robdef_known_service("${file}" "${CMAKE_CURRENT_BINARY_DIR}/${target}_robdef.services/${name}" service check)
    list(APPEND checks ${check})
    robdef_output_names("${service}" cpp names)
    list(FILTER names INCLUDE REGEX "\\.cpp$")
    string(REGEX REPLACE "\\.cpp$" "" name "${names}")
    list(APPEND outputs "${client}/cpp/${name}.cpp" "${client}/mex/${name}.mex.cpp")
  endforeach()

  # The classes name the MEX file's members by their places in all of the files: one command for all.
  set(stamp "${CMAKE_CURRENT_BINARY_DIR}/${target}_robdef.stamp")
  add_custom_command(
    OUTPUT "${stamp}"
    BYPRODUCTS ${outputs}
    ${checks}
    COMMAND ${generator} generate ${config} --lang matlab -o "${arg_OUTPUT_DIR}" ${search}
            --depfile "${stamp}.d" --depfile-target "${stamp}" ${files}
    COMMAND ${CMAKE_COMMAND} -E touch "${stamp}"
    DEPENDS ${files} ${generator}
    DEPFILE "${stamp}.d"
    COMMENT "Generating MATLAB classes for ${target}"
    VERBATIM)
  add_custom_target(${target}_robdef DEPENDS "${stamp}")

  add_library(${target} MODULE ${outputs})
  add_dependencies(${target} ${target}_robdef)
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME rrmex SUFFIX .mex LIBRARY_OUTPUT_DIRECTORY "${arg_OUTPUT_DIR}"
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target} PRIVATE "${client}/cpp" "${client}/mex")
  # Of the runtime nothing is seen outside; see runtime/matlab.
  target_link_libraries(${target} PRIVATE robdef::matlab)
endfunction()
