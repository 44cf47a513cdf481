#pragma once

#include <string>

#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Returns the image of a grid with the pixel draw(cell) for each cell, the northernmost row first.
template <typename Draw>
Image imageOf(const maps::Grid& grid, Draw draw) {
  Image image(grid.width, grid.height);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      image.at(column, grid.height - 1 - row) = draw(maps::Cell{column, row});
  return image;
}

/// Returns the hillshade of an elevation map: brightness 0 to 1 [-] with the sun in the north-west at 45 deg
/// elevation; NaN without data. Flat terrain is vertically exaggerated.
maps::Raster<float> hillshade(const maps::Raster<float>& elevation_m);

/// Returns the brightness values that lit() maps to light 0 and 1: the 2 % and 98 % quantiles.
Range lightRange(const maps::Raster<float>& shade);

/// Returns brightness as a grey image; cells without data are transparent.
Image shadeImage(const maps::Raster<float>& shade);

/// Returns the colours of the allowed headings as an image, mixed by their shares in a cell; cells without
/// data are transparent.
Image headingImage(const maps::Raster<HeadingShares>& headings);

/// Returns a picture of the ground as an image.
Image groundImage(const maps::Raster<std::uint32_t>& ground);

/// Returns the values of a layer as an image in the colours of the layer; NaN is transparent.
Image valueImage(const ValueLayer& layer);

/// Returns the hatching of an area as an image with some pixels a cell; other ground is transparent.
Image hatchImage(const HatchedArea& area);

/// Returns the colour scale of a layer.
Scale scaleOf(const ValueLayer& layer);

/// Returns the scene as a PNG file: a hillshade under the allowed headings (or under the first value layer if there
/// are none), with route, start, goal, scale bar, north arrow, legend and title.
std::string drawPicture(const Scene& scene);

}  // namespace talus::cli
