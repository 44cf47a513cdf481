# `./dev package`: talus (the program), libtalus0 (for programs in C) and libtalus-dev (headers, static libraries, CMake and
# pkg-config), as .deb files with dependencies by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "Talus maintainers <maintainers@users.noreply.github.com>")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# Installs the files built by `./dev`, without the tests.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)

set(about "Talus plans safe routes for rovers: the traversability of a cell is the drawbar\npull that its soil can give, learned from the rover's own wheels, against the\npull that its slope requires.")

# talus_package(NAME SECTION SUMMARY DEPENDS): one package with the texts that Debian requires.
function(talus_package name section summary)
  string(TOUPPER ${name} variable)
  set(CPACK_DEBIAN_${variable}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${variable}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${variable}_DESCRIPTION "${summary}\n${about}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${variable}_PACKAGE_DEPENDS "${ARGN}" PARENT_SCOPE)
  set(texts ${PROJECT_BINARY_DIR}/debian/${name})
  file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
  file(WRITE ${texts}/copyright "Talus\n\n${licence}")
  file(WRITE ${texts}/changelog "${name} (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * See CHANGELOG.md of the source.\n\n"
       " -- ${CPACK_DEBIAN_PACKAGE_MAINTAINER}  Sun, 01 Nov 2026 12:00:00 +0000\n")
  execute_process(COMMAND gzip -9nf ${texts}/changelog COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${texts}/copyright ${texts}/changelog.gz DESTINATION share/doc/${name} COMPONENT ${name} EXCLUDE_FROM_ALL)
endfunction()

# The only shared library for other programs: the package has a shlibs file and updates the loader's cache.
file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs "libtalus ${PROJECT_VERSION_MAJOR} libtalus0 (>= ${PROJECT_VERSION})\n")
file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBTALUS0_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/shlibs ${PROJECT_BINARY_DIR}/debian/triggers)
set(exactly "libtalus0 (= ${PROJECT_VERSION})")
talus_package(libtalus0 libs "safe routes over soft, sloping ground, for programs in C")
talus_package(libtalus-dev libdevel "safe routes over soft, sloping ground, to build programs with"
  "${exactly}, libeigen3-dev, liboctomap-dev, libompl-dev, libgeographiclib-dev, libsqlite3-dev, libboost-dev, libboost-filesystem-dev, libboost-system-dev, libboost-serialization-dev")
set(CPACK_DEBIAN_LIBTALUS-DEV_PACKAGE_SUGGESTS
    "libgdal-dev, nlohmann-json3-dev, libyaml-cpp-dev, libfmt-dev, libnlopt-cxx-dev, libcsv-dev")
set(CPACK_COMPONENTS_ALL libtalus0 libtalus-dev)
if(TALUS_OFFLINE)
  talus_package(talus science "safe routes over soft, sloping ground")
  list(APPEND CPACK_COMPONENTS_ALL talus)
endif()
if(TARGET talus_python)
  math(EXPR next_python "${Python_VERSION_MINOR} + 1")
  talus_package(python3-talus python "safe routes over soft, sloping ground, for Python"
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy")
  list(APPEND CPACK_COMPONENTS_ALL python3-talus)
endif()
include(CPack)
