#!/usr/bin/env bash
# All layers and categories of 4 M cells from the file, beside gdaldem's slope, TRI and roughness of the same
# file in the same run: tests/benchmark/gdaldem.sh BUILD [rounds]. Best of the rounds, in seconds.
set -euo pipefail
talus=$(realpath "$1")/cli/talus
rounds=${2:-5}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$talus" generate craters --size 2000 --resolution 1 --seed 1 -o dem.tif --quiet > /dev/null
TIMEFORMAT='%R %U'

# Wall and user seconds of a command, the least of each over the rounds.
best() {
  for ((i = 0; i < rounds; ++i)); do { time "$@" > /dev/null 2> /dev/null; } 2>&1; done |
    awk 'NR == 1 || $1 < wall { wall = $1 } NR == 1 || $2 < user { user = $2 } END { print wall, user }'
}
three() {
  gdaldem slope dem.tif slope.tif
  gdaldem TRI dem.tif tri.tif
  gdaldem roughness dem.tif roughness.tif
}

read -r wall_g user_g <<< "$(best three)"
read -r wall_t user_t <<< "$(best "$talus" costmap dem.tif --soil dry_sand --rover fido --quiet)"
read -r wall_1 user_1 <<< "$(best "$talus" costmap dem.tif --soil dry_sand --rover fido --quiet --threads 1)"
printf '%-58s %6s %6s\n' '4 M cells' wall user
printf '%-58s %6s %6s\n' "gdaldem slope, TRI, roughness ($(gdalinfo --version | cut -d, -f1))" "$wall_g" "$user_g"
printf '%-58s %6s %6s\n' 'talus costmap: gradients, roughness, step, cost, categories' "$wall_t" "$user_t"
printf '%-58s %6s %6s\n' 'the same, --threads 1' "$wall_1" "$user_1"
awk -v a="$wall_g" -v b="$wall_t" -v c="$user_g" -v d="$user_1" 'BEGIN {
  printf "over gdaldem: %.2f of its wall time, %.2f of its user time on one thread\n", b / a, d / c }'
