# Headers are named <talus/ROOM/...> in the tree as they are once installed: the build folder holds include/talus with a link to
# each room.
set(TALUS_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${TALUS_INCLUDE_DIR}/talus)
foreach(entry terramech maps costmap planner cli talus.hpp plausible.hpp)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${entry} ${TALUS_INCLUDE_DIR}/talus/${entry} SYMBOLIC)
endforeach()
