# cmake --install: libraries, public headers, a CMake package (find_package(sac COMPONENTS decoder encoder)) and a
# pkg-config file.
include(CMakePackageConfigHelpers)

install(DIRECTORY include/sac DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# Those who link sac::decoder ask for nothing of the encoder.
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/sac)
set_target_properties(sac_format PROPERTIES EXPORT_NAME format)
set_target_properties(sac_geometry PROPERTIES EXPORT_NAME geometry)
set_target_properties(sac_codec PROPERTIES EXPORT_NAME codec)
set_target_properties(sac_decoder PROPERTIES EXPORT_NAME decoder)
install(TARGETS sac_decoder sac_codec sac_geometry sac_format EXPORT sac-decoder)
install(EXPORT sac-decoder NAMESPACE sac:: FILE sac-decoder.cmake DESTINATION ${package})
if(SAC_BUILD_ENCODER)
  set_target_properties(sac_rate_control PROPERTIES EXPORT_NAME encoder)
  set_target_properties(sac_encoder PROPERTIES EXPORT_NAME stream_encoder)
  set_target_properties(sac_metrics PROPERTIES EXPORT_NAME metrics)
  install(TARGETS sac_rate_control sac_metrics sac_encoder EXPORT sac-encoder)
  install(EXPORT sac-encoder NAMESPACE sac:: FILE sac-encoder.cmake DESTINATION ${package})
endif()
if(SAC_BUILD_SHARED)
  set_target_properties(sac_shared PROPERTIES EXPORT_NAME shared)
  install(TARGETS sac_shared EXPORT sac-shared)
  install(EXPORT sac-shared NAMESPACE sac:: FILE sac-shared.cmake DESTINATION ${package})
endif()

configure_package_config_file(cmake/sac-config.cmake.in sac-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(sac-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sac-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/sac-config-version.cmake
  DESTINATION ${package})

# Relative, so that what is installed may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/sac.pc.in sac.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sac.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
