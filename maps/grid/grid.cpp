#include <talus/maps/grid/grid.hpp>
