#include <boost/dll/alias.hpp>

// A plugin of a later interface version. The program must not use any symbol other than the version.
namespace other_interface {
extern const int version;
const int version = 99;
extern int planner;
int planner = 0;
}  // namespace other_interface

BOOST_DLL_ALIAS(other_interface::planner, talus_planner)
BOOST_DLL_ALIAS(other_interface::version, talus_planner_interface)
