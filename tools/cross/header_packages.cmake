# SPDX-License-Identifier: Apache-2.0
# Libraries that are headers alone are the same for every system: those of this machine are used, apart from its other
# headers, which the compiler for another system must not see. Included after the first project() of a build with a
# toolchain file (CMAKE_PROJECT_TOP_LEVEL_INCLUDES).
set(host ${CMAKE_BINARY_DIR}/host)
set(folder ${host}/usr/include)
file(MAKE_DIRECTORY ${folder})
foreach(name IN ITEMS boost fmt nlohmann toml++)
  if(NOT EXISTS ${folder}/${name} AND EXISTS /usr/include/${name})
    file(CREATE_LINK /usr/include/${name} ${folder}/${name} SYMBOLIC)
  endif()
endforeach()
list(APPEND CMAKE_FIND_ROOT_PATH ${host})

# What find_package() finds instead of a package of this machine.
function(robdef_header_package name target definitions)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}-config.cmake "
if(NOT TARGET ${target})
  add_library(${target} INTERFACE IMPORTED)
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES \"${folder}\"
    INTERFACE_COMPILE_DEFINITIONS \"${definitions}\")
endif()
")
  # Which version this machine has is for tools/packages to say.
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}-config-version.cmake "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endfunction()
robdef_header_package(fmt fmt::fmt-header-only FMT_HEADER_ONLY=1)
robdef_header_package(nlohmann_json nlohmann_json::nlohmann_json "")
