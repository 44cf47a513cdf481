# The installed package: find_package(talus CONFIG COMPONENTS planner) gives talus::planner and what it stands on; without
# components, all that was built.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/talus)
get_property(talus_components GLOBAL PROPERTY TALUS_COMPONENTS)
configure_package_config_file(cmake/talus-config.cmake.in talus-config.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(talus-config-version.cmake COMPATIBILITY SameMinorVersion)
foreach(component ${talus_components})
  install(EXPORT talus-${component} NAMESPACE talus:: FILE talus-${component}.cmake DESTINATION ${config_dir})
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/talus-config.cmake ${PROJECT_BINARY_DIR}/talus-config-version.cmake
        DESTINATION ${config_dir})
# All installed files, without the tests.
set(installed ${talus_components})
list(TRANSFORM installed PREPEND talus_)
add_custom_target(installed DEPENDS ${installed} talus_plugin)
if(TALUS_OFFLINE)
  add_dependencies(installed talus talus_reproduce)
endif()
if(TARGET talus_python)
  add_dependencies(installed talus_python)
endif()
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
include(debian)
