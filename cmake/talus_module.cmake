# talus_warnings(TARGET): warnings, instrumentation and hardening, for targets of the project only.
function(talus_warnings target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast
    -Woverloaded-virtual -Wdouble-promotion -Wno-missing-field-initializers
    # GCC 12 reports false overlaps in "text" + std::string (GCC bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    $<$<BOOL:${TALUS_WARNINGS_AS_ERRORS}>:-Werror>
    # All variants of a kernel give the same bits: no contraction into fused multiply-add, no -ffast-math.
    -ffp-contract=off -fno-math-errno -fno-trapping-math)
  if(TALUS_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${TALUS_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${TALUS_SANITIZE})
  endif()
  if(TALUS_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage)
    target_link_options(${target} PUBLIC --coverage)
  endif()
  talus_hardening(${target})
endfunction()

# Whether targets are hardened: optimised builds without sanitizers, because sanitizers include these checks.
if(CMAKE_BUILD_TYPE MATCHES "^(Release|RelWithDebInfo|MinSizeRel)$" AND NOT TALUS_SANITIZE)
  set(TALUS_HARDENED ON)
endif()

# talus_hardening(TARGET): because the programs parse untrusted files, a buffer overflow on the stack or in a
# C library call ends the program, and tables of function addresses are read-only at run time
# (docs/security.md).
function(talus_hardening target)
  if(TALUS_HARDENED)
    target_compile_options(${target} PRIVATE -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
    target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now)
  endif()
endfunction()

# talus_unity(TARGET): with TALUS_UNITY, the sources of a folder are compiled together, at most twelve in one
# unit. Names in anonymous namespaces are unique in their folder. Sources with separate options are compiled
# separately.
function(talus_unity target)
  if(NOT TALUS_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "unit_${folder}" folder)
    math(EXPR ${folder} "${${folder}} + 0")
    math(EXPR part "${${folder}} / 12")
    math(EXPR ${folder} "${${folder}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${part})
  endforeach()
endfunction()

# talus_module(NAME PUBLIC ... SOURCES ... [DEPENDS ...] [PRIVATE_DEPENDS ...])
# Defines the library target talus::NAME of a module, and the component NAME of the installed package. Public
# headers, i.e. the umbrella header and all headers that it includes, are a verified file set installed under
# include/talus; other headers are internal and not installed. Paths are relative to the calling module.
function(talus_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "PUBLIC;SOURCES;DEPENDS;PRIVATE_DEPENDS")
  add_library(talus_${name} ${arg_SOURCES})
  add_library(talus::${name} ALIAS talus_${name})
  set_target_properties(talus_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                        CXX_EXTENSIONS OFF VERIFY_INTERFACE_HEADER_SETS ON)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE module)
  list(TRANSFORM arg_PUBLIC PREPEND ${TALUS_INCLUDE_DIR}/talus/${module}/)
  target_sources(talus_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${TALUS_INCLUDE_DIR} FILES ${arg_PUBLIC})
  target_link_libraries(talus_${name} PUBLIC ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS})
  talus_warnings(talus_${name})
  talus_unity(talus_${name})
  install(TARGETS talus_${name} EXPORT talus-${name} FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  set_property(GLOBAL APPEND PROPERTY TALUS_COMPONENTS ${name})
endfunction()

# talus_quick_build(TARGET): compiles code that is not critical for run time with -O1 in Release, for short
# builds.
function(talus_quick_build target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# talus_test(NAME SOURCES ... DEPENDS ...): one GoogleTest program; each of its tests is a ctest case. Code
# shared by the tests of one module is in the folder of the CMakeLists.txt, code shared by several modules in
# tests/support.
function(talus_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_link_libraries(${name} PRIVATE talus::common ${arg_DEPENDS} GTest::gmock_main)
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests/support)
  target_precompile_headers(${name} PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
  talus_quick_build(${name})
  talus_warnings(${name})
  talus_unity(${name})
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES PROPERTIES TIMEOUT 1200)
endfunction()
