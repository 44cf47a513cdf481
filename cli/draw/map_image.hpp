#pragma once

#include <talus/cli/draw/image.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Light on the ground from the north-west, 45 deg high: brightness [-], 0 to 1; NaN without data. Flat
/// ground is shown steeper than it is, so that its shape can be seen.
maps::Raster<float> hillshade(const maps::Raster<float>& elevation_m);

/// Brightnesses that are no light and full light, 0 and 1, where colours are lit(): the 2 % and 98 % quantiles.
Range lightRange(const maps::Raster<float>& shade);

/// Brightness as grey; nodata transparent.
Image shadeImage(const maps::Raster<float>& shade);

/// Category colours, mixed where a cell stands for many; nodata transparent.
Image categoryImage(const maps::Raster<CategoryShares>& categories);

/// Values in colours; NaN transparent.
Image valueImage(const ValueLayer& layer);

/// The colours of a layer's scale.
Scale scaleOf(const ValueLayer& layer);

}  // namespace talus::cli
