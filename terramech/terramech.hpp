#pragma once

/// Umbrella header of talus::terramech: wheel forces on soil, slip and energy of a rover on slopes,
/// traversability categories, and estimation of soil parameters and drawbar pull from wheel readings.

#include <talus/common/constants.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/pull_forecast.hpp>
#include <talus/terramech/estimate/soil_filter.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/category_probability.hpp>
#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/strength/linear_offset.hpp>
