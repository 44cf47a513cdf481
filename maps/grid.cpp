#include <talus/maps/grid.hpp>
