# libsac: the interface of C, decoder and encoder, and nothing else. What else is in there stays apart from the program's
# own Eigen and Draco.
set(libraries sac_decoder sac_codec sac_geometry sac_format)
set(interface sac_decoder)
if(SAC_BUILD_ENCODER)
  list(PREPEND libraries sac_rate_control sac_metrics sac_encoder)
  list(PREPEND interface sac_rate_control sac_encoder)
endif()
list(JOIN interface "," interface)
add_library(sac_shared SHARED cmake/shared.cpp)
add_library(sac::shared ALIAS sac_shared)
target_link_libraries(sac_shared PRIVATE ${libraries} $<BUILD_INTERFACE:sac_options>)
target_compile_definitions(sac_shared INTERFACE SAC_USES_SHARED)
target_include_directories(sac_shared INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
if(NOT APPLE AND NOT WIN32)
  target_link_options(sac_shared PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/shared.map)
endif()
set_target_properties(sac_shared PROPERTIES
  LINK_LIBRARY_OVERRIDE "WHOLE_ARCHIVE,${interface}"
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/shared.map
  OUTPUT_NAME sac VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
