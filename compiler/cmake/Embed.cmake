# SPDX-License-Identifier: Apache-2.0
# Compiles files into a program.
#   robdef_embed(TARGET OUTPUT x.cpp HEADER "a/b.hpp" FUNCTION robdef::cpp::embedded_templates FILES ...)
# writes the definition of FUNCTION, which HEADER declares: it returns robdef::TemplateSources with
# each file under its name.

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  string(REPLACE "|" ";" FILES "${FILES}")
  set(entries "")
  foreach(path IN LISTS FILES)
    get_filename_component(name "${path}" NAME)
    file(READ "${path}" text)
    string(APPEND entries "      {\"${name}\", R\"embed(${text})embed\"},\n")
  endforeach()
  file(WRITE "${OUTPUT}.new"
    "#include \"${HEADER}\"\n\nrobdef::TemplateSources ${FUNCTION}() {\n  return {\n${entries}  };\n}\n")
  file(COPY_FILE "${OUTPUT}.new" "${OUTPUT}" ONLY_IF_DIFFERENT)
  file(REMOVE "${OUTPUT}.new")
  return()
endif()

set(robdef_embed_script "${CMAKE_CURRENT_LIST_FILE}")
function(robdef_embed target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "OUTPUT;HEADER;FUNCTION" "FILES")
  list(TRANSFORM arg_FILES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  list(JOIN arg_FILES "|" files)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/${arg_OUTPUT}")
  add_custom_command(OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DFILES=${files}" "-DOUTPUT=${output}" "-DHEADER=${arg_HEADER}"
            "-DFUNCTION=${arg_FUNCTION}" -P "${robdef_embed_script}"
    DEPENDS ${arg_FILES} "${robdef_embed_script}"
    COMMENT "Embedding the files of ${arg_FUNCTION}"
    VERBATIM)
  robdef_compiled_in(home ${target})
  target_sources(${home} PRIVATE "${output}")
  if(NOT home STREQUAL target)
    # Of another folder, it does not see the command.
    add_custom_target(${target}_embedded DEPENDS "${output}")
    add_dependencies(${home} ${target}_embedded)
  endif()
endfunction()
