#!/usr/bin/env bash
# docs/demo.sh TALUS [OUTPUT_DIR]: plans across a real map that Debian ships (Jacksboro fault, python-matplotlib-data) and
# across a generated lunar crater field; for each it writes a route, a picture and a page, and prints a summary.
set -euo pipefail
talus=$(realpath "${1:?usage: docs/demo.sh PATH_TO_TALUS [OUTPUT_DIR]}")
mkdir -p "${2:-demo}"
cd "${2:-demo}"

jacksboro=/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz
[ -f "$jacksboro" ] || { echo "demo: $jacksboro is missing; apt-get install python-matplotlib-data" >&2; exit 2; }

# plan NAME ARGUMENT...: a route, its picture and its page.
plan() {
  local name=$1
  shift
  echo "== $name"
  "$talus" plan "$@" -o "$name.geojson" --png "$name.png" --html "$name.html"
  echo "page                 $PWD/$name.html"
  echo
}

plan jacksboro "$jacksboro" --rover fido --soil testbed_topsoil --start 2300,300 --goal 14300,11000
"$talus" --quiet generate craters --size 800 --resolution 1 --seed 7 -o moon.tif >/dev/null
plan moon moon.tif --terrain moon_classes.tif --soils moon_soils.yaml --rocks moon_rocks.tif --rover lunar_micro \
  --start 40,40 --goal 760,740
