# SPDX-License-Identifier: Apache-2.0
# cmake --install: libraries, public headers, a CMake package (find_package(sac COMPONENTS decoder encoder decomposition
# shared)) and two pkg-config files: sac for C, which is the shared library where there is one, and sac-cxx for C++.
include(CMakePackageConfigHelpers)
# Those who want the libraries without the command: cmake --install BUILD --component sac_library
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME sac_library)

install(DIRECTORY include/sac DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/sac)

# sac_install(COMPONENT TARGET...): the targets as a component of the package, each as sac::NAME.
function(sac_install component)
  foreach(target IN LISTS ARGN)
    string(REGEX REPLACE "^sac_" "" name ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  endforeach()
  install(TARGETS ${ARGN} EXPORT sac-${component})
  install(EXPORT sac-${component} NAMESPACE sac:: FILE sac-${component}.cmake DESTINATION ${package})
endfunction()

# The order is that of a linker's command line: a library stands before those that it needs.
set(static_libraries sac_decoder sac_codec sac_geometry sac_format)
sac_install(decoder ${static_libraries})
if(SAC_BUILD_ENCODER)
  sac_install(encoder sac_rate_control sac_metrics sac_encoder)
  list(PREPEND static_libraries sac_rate_control sac_metrics sac_encoder)
  # Who links the encoder gets all of it; its part without search and metrics is the stream encoder.
  set_target_properties(sac_rate_control PROPERTIES EXPORT_NAME encoder)
  set_target_properties(sac_encoder PROPERTIES EXPORT_NAME stream_encoder)
endif()
if(SAC_BUILD_DECOMPOSITION)
  sac_install(decomposition sac_decomposition)
  list(PREPEND static_libraries sac_decomposition)
endif()
if(SAC_BUILD_SHARED)
  # Debian's packages keep what programs load apart from what is needed to link them.
  set(runtime sac_library)
  if(SAC_PACKAGES)
    set(runtime sac_runtime)
  endif()
  set_target_properties(sac_shared PROPERTIES EXPORT_NAME shared)
  install(TARGETS sac_shared EXPORT sac-shared RUNTIME COMPONENT ${runtime}
    LIBRARY COMPONENT ${runtime} NAMELINK_COMPONENT sac_library ARCHIVE COMPONENT sac_library)
  install(EXPORT sac-shared NAMESPACE sac:: FILE sac-shared.cmake DESTINATION ${package})
endif()

configure_package_config_file(cmake/sac-config.cmake.in sac-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(sac-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sac-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/sac-config-version.cmake
  DESTINATION ${package})

# The prefix is relative to the pkg-config file, so that what is installed may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
list(TRANSFORM static_libraries PREPEND -l)
list(JOIN static_libraries " " static_libraries)
set(description "${PROJECT_DESCRIPTION}, for C++")
set(requires draco)
set(libraries "${static_libraries} -pthread")
configure_file(cmake/sac.pc.in sac-cxx.pc @ONLY)
set(description "${PROJECT_DESCRIPTION}, for C")
if(SAC_BUILD_SHARED)
  set(requires "")
  set(libraries -lsac)
else()
  # A linker that a C compiler drives has to be told of the C++ library.
  set(cxx_library ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(FILTER cxx_library INCLUDE REGEX "^(std)?c[+][+]$")
  list(TRANSFORM cxx_library PREPEND -l)
  list(JOIN cxx_library " " cxx_library)
  string(APPEND libraries " ${cxx_library} -lm")
endif()
configure_file(cmake/sac.pc.in sac.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sac.pc ${CMAKE_CURRENT_BINARY_DIR}/sac-cxx.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
unset(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME)
