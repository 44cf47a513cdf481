#!/usr/bin/env bash
# docs/demo.sh TALUS [OUTPUT_DIR]: plans across a real map that Debian ships (Jacksboro fault, python-matplotlib-data) and
# across a generated lunar crater field; for each it writes a route, a picture and a page, and prints a summary.
set -euo pipefail
talus=$(realpath "${1:?usage: docs/demo.sh PATH_TO_TALUS [OUTPUT_DIR]}")
mkdir -p "${2:-demo}"
cd "${2:-demo}"

jacksboro=/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz
[ -f "$jacksboro" ] || { echo "demo: $jacksboro is missing; apt-get install python-matplotlib-data" >&2; exit 2; }
# The file names its northern edge ymin.
/usr/bin/python3 - "$jacksboro" <<'END'
import sys, numpy
m = numpy.load(sys.argv[1])
z, x, y = m["elevation"], sorted((m["xmin"], m["xmax"])), sorted((m["ymin"], m["ymax"]))
head = f"ncols {z.shape[1]}\nnrows {z.shape[0]}\nxllcorner {x[0]}\nyllcorner {y[0]}\ndx {(x[1] - x[0]) / z.shape[1]}\ndy {(y[1] - y[0]) / z.shape[0]}"
numpy.savetxt("jacksboro.asc", z, "%d", header=head, comments="")
open("jacksboro.prj", "w").write('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
                                 'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
END

# plan NAME ARGUMENT...: a route, its picture and its page.
plan() {
  local name=$1
  shift
  echo "== $name"
  "$talus" plan "$@" -o "$name.geojson" --png "$name.png" --html "$name.html"
  echo "page                 $PWD/$name.html"
  echo
}

plan jacksboro jacksboro.asc --rover fido --soil testbed_topsoil --start 2300,300 --goal 14300,11000
"$talus" --quiet generate craters --size 800 --resolution 1 --seed 7 -o moon.tif >/dev/null
plan moon moon.tif --terrain moon_classes.tif --soils moon_soils.yaml --rocks moon_rocks.tif --rover lunar_micro \
  --start 40,40 --goal 760,740
