# SPDX-License-Identifier: Apache-2.0
# libsac is the interface of C and exports nothing else, so that its Eigen and Draco stay apart from the program's own. It
# compiles that interface itself, with SAC_BUILDS_SHARED, which Windows needs for what it exports; the rest comes from
# the static libraries.
set(sources codec/decode/c_api.cpp)
set(libraries sac_decoder sac_codec sac_geometry sac_format)
if(SAC_BUILD_ENCODER)
  list(APPEND sources codec/encode/c_api.cpp metrics/c_api.cpp rate_control/c_api.cpp)
  list(PREPEND libraries sac_rate_control sac_metrics sac_encoder)
endif()
if(SAC_BUILD_DECOMPOSITION)
  list(APPEND sources decomposition/c_api.cpp)
  list(PREPEND libraries sac_decomposition)
endif()
add_library(sac_shared SHARED ${sources})
add_library(sac::shared ALIAS sac_shared)
target_link_libraries(sac_shared PRIVATE ${libraries} $<BUILD_INTERFACE:sac_options>)
target_compile_definitions(sac_shared PRIVATE SAC_BUILDS_SHARED INTERFACE SAC_USES_SHARED)
target_include_directories(sac_shared INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(sac_shared PROPERTIES
  OUTPUT_NAME sac VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(SAC_STANDALONE)
  # Before the shared Draco that the libraries name; what is found twice is taken from the first.
  find_library(static_draco NAMES libdraco.a REQUIRED)
  target_link_options(sac_shared PRIVATE -static-libstdc++ -static-libgcc LINKER:--as-needed,--strip-all)
  target_link_libraries(sac_shared PRIVATE ${static_draco})
endif()
if(APPLE)
  target_link_options(sac_shared PRIVATE -Wl,-exported_symbol,_sac_*)
elseif(NOT WIN32)
  set(map ${PROJECT_SOURCE_DIR}/cmake/shared.map)
  target_link_options(sac_shared PRIVATE -Wl,--version-script=${map})
  set_target_properties(sac_shared PROPERTIES LINK_DEPENDS ${map})
endif()
