# cmake --install: the decoder library, its headers, a CMake package (find_package(sac)) and a pkg-config file.
include(CMakePackageConfigHelpers)

# What codec/decode/decoder.h includes, and the header for C.
set(headers
  geometry/bounding_box.h
  codec/decode/decoder.h
  codec/decode/lost_frames.h
  codec/decode/vertex_buffer.h
  geometry/mesh.h
  format/bytes.h
  format/limits.h
  format/sequence_header.h
  format/status.h)
foreach(header ${headers})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sac/${folder})
endforeach()
install(FILES codec/decode/sac.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sac)

set_target_properties(sac_decoder PROPERTIES EXPORT_NAME decoder)
set_target_properties(sac_codec PROPERTIES EXPORT_NAME codec)
set_target_properties(sac_format PROPERTIES EXPORT_NAME format)
set_target_properties(sac_geometry PROPERTIES EXPORT_NAME geometry)
set(libraries sac_decoder sac_codec sac_format sac_geometry)
if(SAC_BUILD_SHARED)
  set_target_properties(sac_decoder_shared PROPERTIES EXPORT_NAME decoder_shared)
  list(APPEND libraries sac_decoder_shared)
endif()
install(TARGETS ${libraries} EXPORT sac)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/sac)
install(EXPORT sac NAMESPACE sac:: FILE sac-targets.cmake DESTINATION ${package})
configure_package_config_file(cmake/sac-config.cmake.in sac-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(sac-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sac-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/sac-config-version.cmake
  DESTINATION ${package})

# Relative, so that what is installed may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/sac.pc.in sac.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sac.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
