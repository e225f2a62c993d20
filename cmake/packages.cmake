# SPDX-License-Identifier: Apache-2.0
# cpack: sac, libsac0, libsac-dev and python3-sac for Debian, from a build with SAC_PACKAGES (the preset `package`).
set(debian ${CMAKE_CURRENT_LIST_DIR}/debian)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL sac_command sac_runtime sac_library sac_python)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(SAC_MAINTAINER "The sac authors <nobody@sac.invalid>" CACHE STRING "Who made the packages")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${SAC_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(package_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# The lists of changes, of the project and of the packages.
set(documents ${PROJECT_BINARY_DIR}/packages)
configure_file(CHANGELOG.md ${documents}/changelog COPYONLY)
string(TIMESTAMP package_date "%a, %d %b %Y 00:00:00 +0000" UTC)
configure_file(${debian}/changelog.in ${documents}/changelog.Debian @ONLY)
execute_process(COMMAND gzip -9nf changelog changelog.Debian WORKING_DIRECTORY ${documents} COMMAND_ERROR_IS_FATAL ANY)

# sac_package(COMPONENT NAME SECTION BRIEF TEXT): the component as a package with its copyright and lists of changes.
function(sac_package component name section brief text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${brief}\n${what}\n${text}" PARENT_SCOPE)
  install(FILES ${debian}/copyright ${documents}/changelog.gz ${documents}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endfunction()

# Line breaks as Debian has them, after fewer than 80 characters.
string(CONCAT what "sac compresses animated triangle meshes, one connectivity whose vertices\n"
  "move, into a stream several hundred times smaller than the positions.")
sac_package(sac_command sac graphics "codec for animated triangle meshes"
  "This package has the command, which encodes, decodes, measures and plays.")
set(CPACK_DEBIAN_SAC_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SAC_COMMAND_PACKAGE_RECOMMENDS libglfw3)

sac_package(sac_runtime libsac0 libs "codec for animated triangle meshes, shared library"
  "This package has the shared library, an interface of C.")
set(CPACK_DEBIAN_SAC_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SAC_RUNTIME_PACKAGE_CONTROL_EXTRA ${debian}/libsac0/triggers)

sac_package(sac_library libsac-dev libdevel "codec for animated triangle meshes, headers"
  "This package has the headers, the static libraries for C++, a CMake\npackage and pkg-config files.")
set(CPACK_DEBIAN_SAC_LIBRARY_PACKAGE_DEPENDS "libsac0 (= ${package_version}), libdraco-dev")

install(DIRECTORY ${PROJECT_SOURCE_DIR}/bindings/python/sac DESTINATION lib/python3/dist-packages COMPONENT sac_python
  FILES_MATCHING PATTERN "*.py" PATTERN py.typed PATTERN __pycache__ EXCLUDE)
sac_package(sac_python python3-sac python "codec for animated triangle meshes, for Python"
  "This package has the Python module, which gives frames as arrays of numpy.")
set(CPACK_DEBIAN_SAC_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_SAC_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.9), python3-numpy, libsac0 (= ${package_version})")
set(CPACK_DEBIAN_SAC_PYTHON_PACKAGE_CONTROL_EXTRA ${debian}/python3-sac/postinst ${debian}/python3-sac/prerm)

include(CPack)
