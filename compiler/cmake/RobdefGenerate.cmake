# SPDX-License-Identifier: Apache-2.0
# robdef_generate(TARGET
#   FILES a.robdef ...        definitions to generate code for; absolute or in the current source folder
#   LANGUAGE cpp              or cbus: C99 for pods as buses; or typescript
#   [PLUGIN program]          in place of LANGUAGE: a program that makes the files; a path is absolute or in the
#                             current source folder, a name is one along PATH, or a plug-in of CONFIG
#   [PLUGIN_OPTIONS key=value ...]
#   [IMPORT_PATHS dir ...]    where imported definitions are looked for; the folders of FILES and the
#                             environment variable ROBOTRACONTEUR_ROBDEF_PATH are searched too
#   [CONFIG robdef.toml]      project file with renames and levels of warnings; none by default, wherever one is
#   [OUTPUT_DIR dir])         default: <current binary folder>/TARGET_robdef
#
# Generates code while TARGET is built, and adds it to TARGET: the sources, the include folder and
# the runtime, both passed on to what links TARGET. TARGET is a library or program made before.
# For a service a.b.c the header is included as "a/b/c.hpp", of a bus as "a_b_c_bus.h"; a bus stands on
# robdef::cbus and not on the runtime, and what Simulink needs lies beside it. Nothing is generated for imports: give
# them as FILES too, here or in another target that is linked.
#
# With LANGUAGE typescript, TARGET is a custom target: the modules a.b.c.ts are in OUTPUT_DIR when it is built, and what
# compiles them depends on it. Nothing is linked.
#
# With PLUGIN it is the same: TARGET is a custom target, the plug-in runs once for each definition, and what it makes
# is in OUTPUT_DIR when TARGET is built.
#
# Each definition has a command of its own that knows all files it read, so an edited import runs
# again exactly what depends on it; files whose text stays the same are not touched.
#
# Works with the target robdef of this tree and with robdef::robdef of an installed package.
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

# The paths below OUTPUT_DIR that are generated for `file`. They follow from the service line, so they
# are known before the compiler is built; a test compares them with what is generated.
function(robdef_output_names file language result)
  if(language STREQUAL "cpp")
    set(endings .hpp .cpp)
    set(separator "/")
  elseif(language STREQUAL "cbus")
    set(endings _bus.h _bus.c)
    set(separator "_")
  elseif(language STREQUAL "typescript")
    set(endings .ts)
    set(separator ".")
  else()
    message(FATAL_ERROR "robdef_generate: unknown LANGUAGE `${language}`; known: cpp, cbus, typescript")
  endif()
  file(READ "${file}" text)
  # The first statement; in front of it may stand blanks and a byte order mark.
  if(NOT text MATCHES "(^|\n)[^A-Za-z0-9_#\n]*service[ \t\r\n\\\\]+([A-Za-z0-9_.]+)")
    message(FATAL_ERROR "${file}: there is no service line")
  endif()
  string(REPLACE "." "${separator}" path "${CMAKE_MATCH_2}")
  list(TRANSFORM endings PREPEND "${path}")
  set(${result} "${endings}" PARENT_SCOPE)
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

function(robdef_generate target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "CONFIG;LANGUAGE;OUTPUT_DIR;PLUGIN" "FILES;IMPORT_PATHS;PLUGIN_OPTIONS")
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

  set(maker --lang "${arg_LANGUAGE}")
  set(maker_files "")
  set(made_by "${arg_LANGUAGE}")
  if(arg_PLUGIN)
    robdef_plugin_maker("${arg_PLUGIN}" "${arg_PLUGIN_OPTIONS}" maker maker_files)
    cmake_path(GET arg_PLUGIN FILENAME made_by)
  endif()

  set(stamps "")
  foreach(file IN LISTS files)
    # A new service name means new file names.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
    set(names "")
    if(NOT arg_PLUGIN)
      robdef_output_names("${file}" "${arg_LANGUAGE}" names)
    endif()
    list(TRANSFORM names PREPEND "${arg_OUTPUT_DIR}/" OUTPUT_VARIABLE outputs)
    cmake_path(GET file FILENAME name)
    set(stamp "${CMAKE_CURRENT_BINARY_DIR}/${target}_robdef.stamps/${name}")
    # The generated files are byproducts, since they keep their old time when their text stays the
    # same; the stamp says when the command last ran.
    add_custom_command(
      OUTPUT "${stamp}.stamp"
      BYPRODUCTS ${outputs}
      COMMAND robdef::robdef generate ${config} ${maker} -o "${arg_OUTPUT_DIR}" ${search}
              --depfile "${stamp}.d" --depfile-target "${stamp}.stamp" "${file}"
      COMMAND ${CMAKE_COMMAND} -E touch "${stamp}.stamp"
      DEPENDS "${file}" ${maker_files} robdef::robdef
      DEPFILE "${stamp}.d"
      COMMENT "Generating ${made_by} from ${name}"
      VERBATIM)
    list(APPEND stamps "${stamp}.stamp")
    if(NOT arg_PLUGIN AND NOT arg_LANGUAGE STREQUAL "typescript")
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

  if(arg_PLUGIN OR arg_LANGUAGE STREQUAL "typescript")
    return()
  endif()
  target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${arg_OUTPUT_DIR}>")
  # By property, so that the caller may link in either form of target_link_libraries.
  set(library robdef::runtime)
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
  set(client "${arg_OUTPUT_DIR}/client")
  set(outputs "${client}/client.cpp")
  foreach(folder IN LISTS arg_IMPORT_PATHS)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND search "-I${folder}")
  endforeach()
  foreach(file IN LISTS arg_FILES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND files "${file}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
    robdef_output_names("${file}" cpp names)
    list(FILTER names INCLUDE REGEX "\\.cpp$")
    string(REGEX REPLACE "\\.cpp$" "" name "${names}")
    list(APPEND outputs "${client}/cpp/${name}.cpp" "${client}/mex/${name}.mex.cpp")
  endforeach()

  # The classes name the MEX file's members by their places in all of the files: one command for all.
  set(stamp "${CMAKE_CURRENT_BINARY_DIR}/${target}_robdef.stamp")
  add_custom_command(
    OUTPUT "${stamp}"
    BYPRODUCTS ${outputs}
    COMMAND robdef::robdef generate ${config} --lang matlab -o "${arg_OUTPUT_DIR}" ${search}
            --depfile "${stamp}.d" --depfile-target "${stamp}" ${files}
    COMMAND ${CMAKE_COMMAND} -E touch "${stamp}"
    DEPENDS ${files} robdef::robdef
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
