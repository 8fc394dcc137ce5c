# SPDX-License-Identifier: Apache-2.0
# What is installed for Windows: `tools/package windows` makes a zip of it. Included last, when all targets are there.
# Programs link static libraries and need no DLL; robdef_c.dll is for other languages.
if(NOT ROBDEF_OPENSSL)
  return()
endif()
include(CMakePackageConfigHelpers)
set(package_folder lib/cmake/robdef)
install(TARGETS robdef robdef_c EXPORT robdefTargets RUNTIME DESTINATION bin ARCHIVE DESTINATION lib)
install(TARGETS robdef_core robdef_tls robdef_web robdef_runtime EXPORT robdefStaticTargets ARCHIVE DESTINATION lib)
install(TARGETS robdef_dynamic robdef_serial EXPORT robdefDynamicTargets ARCHIVE DESTINATION lib)
foreach(part IN ITEMS "" Static Dynamic)
  install(EXPORT robdef${part}Targets NAMESPACE robdef:: DESTINATION ${package_folder})
endforeach()
# For compilers that make import libraries of their own form.
install(FILES ${PROJECT_BINARY_DIR}/runtime/c/robdef_c.def DESTINATION lib)
install(FILES ${ROBDEF_OPENSSL}/lib/libssl.a ${ROBDEF_OPENSSL}/lib/libcrypto.a DESTINATION lib)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/cpp/include/rr DESTINATION include FILES_MATCHING PATTERN "*.h*")
install(FILES ${PROJECT_SOURCE_DIR}/runtime/c/include/rr.h DESTINATION include)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/c/include/rr_c DESTINATION include)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/robdefConfig.cmake.in ${PROJECT_BINARY_DIR}/robdefConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/robdefConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/RobdefGenerate.cmake ${PROJECT_BINARY_DIR}/robdefConfig.cmake
  ${PROJECT_BINARY_DIR}/robdefConfigVersion.cmake DESTINATION ${package_folder})
