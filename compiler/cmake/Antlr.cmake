# SPDX-License-Identifier: Apache-2.0
# Lexers and parsers from grammars: the ANTLR tool and its C++ runtime, and one function.

set(ROBDEF_ANTLR_SOURCES "" CACHE PATH
  "Debian's source package antlr4-cpp-runtime, for systems without its library: it is compiled here")
if(ROBDEF_ANTLR_SOURCES)
  set(ROBDEF_ANTLR_INCLUDE ${ROBDEF_ANTLR_SOURCES}/runtime/src)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${ROBDEF_ANTLR_INCLUDE}/*.cpp)
  add_library(antlr4_static STATIC ${sources})
  # As Debian compiles it: its headers have no string_view.
  set_target_properties(antlr4_static PROPERTIES CXX_STANDARD 14)
  target_compile_definitions(antlr4_static PUBLIC ANTLR4CPP_STATIC)
  # Found in the folders of all, as its own build does; warnings are its makers'.
  file(GLOB_RECURSE headers ${ROBDEF_ANTLR_INCLUDE}/*.h)
  list(TRANSFORM headers REPLACE "/[^/]+$" "")
  list(REMOVE_DUPLICATES headers)
  target_include_directories(antlr4_static SYSTEM PRIVATE ${headers})
  target_compile_options(antlr4_static PRIVATE -w)
else()
  # The package's configuration names two libraries, but knows neither their headers nor that they
  # want libuuid to be linked.
  find_package(antlr4-runtime 4.9 REQUIRED CONFIG)
  find_path(ROBDEF_ANTLR_INCLUDE antlr4-runtime.h
    HINTS ${ANTLR4_INCLUDE_DIR} PATH_SUFFIXES antlr4-runtime REQUIRED)
endif()
# Not asked for where a source package brings what it makes.
find_program(ROBDEF_ANTLR_TOOL NAMES antlr4
  DOC "The ANTLR 4 tool, 4.7.2 or later but before 4.10, whose tables the runtime cannot read")

# robdef_grammar(NAME LEXER file PARSER file NAMESPACE name)
# A static library of the lexer and parser of a grammar. Its sources are C++17, since tool 4.7
# writes u8"" where it means char; its headers can be included from C++20. What is in the folder `generated` beside the
# grammar is taken as it is, without the tool and its Java: source packages have it (tools/source_package).
function(robdef_grammar name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "LEXER;PARSER;NAMESPACE" "")
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(is_there FALSE)
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/generated)
    set(folder ${CMAKE_CURRENT_SOURCE_DIR}/generated)
    set(is_there TRUE)
  elseif(NOT ROBDEF_ANTLR_TOOL)
    message(FATAL_ERROR "the ANTLR tool `antlr4` is missing; a source package needs none")
  endif()
  set(sources)
  set(others)
  foreach(grammar ${arg_LEXER} ${arg_PARSER})
    get_filename_component(stem ${grammar} NAME_WE)
    list(APPEND sources ${folder}/${stem}.cpp)
    list(APPEND others ${folder}/${stem}.h ${folder}/${stem}.tokens ${folder}/${stem}.interp)
  endforeach()
  if(NOT is_there)
    # Relative names, because the tool writes the name into what it generates.
    add_custom_command(
      OUTPUT ${sources} ${others}
      COMMAND ${ROBDEF_ANTLR_TOOL} -Werror -Dlanguage=Cpp -no-visitor -no-listener
        -package ${arg_NAMESPACE} -Xexact-output-dir -o ${folder} ${arg_LEXER} ${arg_PARSER}
      WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
      DEPENDS ${arg_LEXER} ${arg_PARSER}
      COMMENT "Generating ${arg_PARSER}"
      VERBATIM)
  endif()
  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES CXX_STANDARD 17)
  target_include_directories(${name} SYSTEM PUBLIC ${folder} ${ROBDEF_ANTLR_INCLUDE})
  if(ROBDEF_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON)
    # Most of its work is done by the runtime.
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  target_link_libraries(${name} PUBLIC antlr4_static)
endfunction()
