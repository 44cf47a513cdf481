# Headers are included as <talus/MODULE/...> in the source tree and after installation: the build folder
# contains include/talus with a link to each module, and a copy of talus.hpp, because a link to a file would
# be installed as a link.
set(TALUS_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${TALUS_INCLUDE_DIR}/talus)
foreach(entry common terramech maps costmap planner cli)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${entry} ${TALUS_INCLUDE_DIR}/talus/${entry} SYMBOLIC)
endforeach()
if(IS_SYMLINK ${TALUS_INCLUDE_DIR}/talus/talus.hpp)  # link in a build folder of an older version
  file(REMOVE ${TALUS_INCLUDE_DIR}/talus/talus.hpp)
endif()
configure_file(talus.hpp ${TALUS_INCLUDE_DIR}/talus/talus.hpp COPYONLY)
