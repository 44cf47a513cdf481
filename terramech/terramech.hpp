#pragma once

/// Umbrella header of talus::terramech: wheel forces on soil, slip and energy of a rover on slopes,
/// traversability categories, and estimation of soil parameters and drawbar pull from wheel readings.

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/strength/strength_lines.hpp>
