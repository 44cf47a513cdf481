# Headers are named <talus/MODULE/...> in the tree as they are once installed: the build folder holds include/talus with a link to
# each module, and a copy of talus.hpp: a link to a file would be installed as a link, into this tree.
set(TALUS_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${TALUS_INCLUDE_DIR}/talus)
foreach(entry common terramech maps costmap planner cli)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${entry} ${TALUS_INCLUDE_DIR}/talus/${entry} SYMBOLIC)
endforeach()
if(IS_SYMLINK ${TALUS_INCLUDE_DIR}/talus/talus.hpp)  # of a build folder from before
  file(REMOVE ${TALUS_INCLUDE_DIR}/talus/talus.hpp)
endif()
configure_file(talus.hpp ${TALUS_INCLUDE_DIR}/talus/talus.hpp COPYONLY)
