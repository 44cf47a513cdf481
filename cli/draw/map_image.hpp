#pragma once

#include <talus/cli/draw/image.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Hillshade with the sun in the north-west at 45 deg elevation: brightness 0 to 1 [-]; NaN without data.
/// Flat terrain is vertically exaggerated.
maps::Raster<float> hillshade(const maps::Raster<float>& elevation_m);

/// Brightness values that lit() maps to light 0 and 1: the 2 % and 98 % quantiles.
Range lightRange(const maps::Raster<float>& shade);

/// Brightness as grey; cells without data are transparent.
Image shadeImage(const maps::Raster<float>& shade);

/// Category colours, mixed by the shares of a cell; cells without data are transparent.
Image categoryImage(const maps::Raster<CategoryShares>& categories);

/// Returns the values in the colours of the layer; NaN is transparent.
Image valueImage(const ValueLayer& layer);

/// Colour scale of a layer.
Scale scaleOf(const ValueLayer& layer);

}  // namespace talus::cli
