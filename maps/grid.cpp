#include <maps/grid.hpp>
