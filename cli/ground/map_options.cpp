#include <utility>

#include <CLI/CLI.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/help_format.hpp>
#include <talus/cli/app/number_check.hpp>
#include <talus/cli/ground/map_options.hpp>

namespace talus::cli {

void addMapOptions(CLI::App& command, ElevationFile& file, const std::string& name) {
  command.add_option(name, file.path, "elevation map: any GDAL raster, a NumPy .npz, or an OctoMap")
      ->required();
  addReadOptions(command, file);
}

void addReadOptions(CLI::App& command, ElevationFile& file) {
  maps::ReadOptions& read = file.read;
  command.add_option("--band", read.band, "band of elevations, counted from 1")->type_name("N");
  command
      .add_option("--resolution", read.resolution_m,
                  "cell size; required without a CRS; resamples with a CRS")
      ->type_name("METRES");
  command
      .add_option("--window", file.window,
                  "read only this window: x0,y0,x1,y1, or lat,lon,lat,lon with the suffix d on each")
      ->type_name("BOX");
  command.add_option("--nodata", read.nodata, "value of cells without data")->type_name("VALUE");
  command.add_flag("--keep-holes", read.keep_holes,
                   "leave single cells without data unknown instead of interpolating them");
  command
      .add_option("--vertical-scale", read.vertical_scale,
                  "factor on the heights; metres per unit where the file states an unknown one")
      ->type_name("FACTOR");
  command.add_flag("--ignore-crs", read.ignore_crs,
                   "ignore a wrong CRS and read as local metres (with --resolution)");
  command.add_flag("--allow-vrt", read.allow_vrt,
                   "read a virtual raster (VRT) whose files lie in its own folder");
  command
      .add_option("--below", file.below_m,
                  "of an OctoMap: use the ground at or below this elevation, as under a bridge")
      ->type_name("METRES");
  command.add_option("--max-cells", read.max_cells, "largest accepted map, in cells")
      ->type_name("N")
      ->check(within(1.0, 1e15))
      ->capture_default_str();
  groupOptions(command, "Elevation map");
}

void addLayerOptions(CLI::App& command, SiteFiles& files) {
  command.add_option("--terrain", files.classes, "raster of terrain classes")->type_name("FILE");
  command.add_option("--terrain-band", files.classes_band, "band of the raster, counted from 1")
      ->type_name("N");
  command.add_option("--rocks", files.rocks, "raster of rock abundance, 0 to 1")->type_name("FILE");
  command.add_option("--rocks-band", files.rocks_band, "band of the raster, counted from 1")->type_name("N");
  command
      .add_option("--keep-out", files.keep_out, "polygons of a vector file to keep out of; may be repeated")
      ->type_name("FILE");
  command
      .add_option(
          "--layer", files.costs,
          "joules a metre to add, as NAME=FILE of a raster or a layer plugin (.so): inf is refused, no data "
          "counts as unknown; may be repeated")
      ->type_name("NAME=FILE");
  groupOptions(command, "Layers");
}

SiteReading readingOf(const Context& context) {
  return {.threads = context.workers(),
          .note = [&context](std::string_view line) { context.warn(line); },
          .watch = context.watch("read map")};
}

}  // namespace talus::cli
