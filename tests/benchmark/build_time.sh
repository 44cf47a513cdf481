#!/usr/bin/env bash
# CPU time of builds from nothing, without a compiler cache: tests/benchmark/build_time.sh [FOLDER]. Prints a table: the program,
# everything (tests and benchmarks too), and what one changed header of costmap costs then; in the release preset, and
# with each source compiled alone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=${1:-$(mktemp -d)}
export CCACHE_DISABLE=1
header=costmap/cost/cost_grid.hpp

# seconds COMMAND...: CPU seconds and seconds of the clock of a command.
seconds() {
  local TIMEFORMAT='%U %S %R'
  { time "$@" >"$folder/log" 2>&1 || { tail -5 "$folder/log" >&2; exit 1; }; } 2>&1 | awk '{ printf "%.0f %.0f", $1 + $2, $3 }'
}

printf '%-34s %8s %8s\n' build 'CPU s' 'clock s'
for unity in ON OFF; do
  tree=$folder/unity-$unity
  rm -rf "$tree"
  cmake --preset release -B "$tree" -DTALUS_UNITY=$unity -DTALUS_BENCHMARKS=ON >"$folder/log"
  kind=$([ $unity = ON ] && echo 'folders together' || echo 'each source alone')
  printf '%-34s %8s %8s\n' "program, $kind" $(seconds cmake --build "$tree" --target talus -- -j2)
  printf '%-34s %8s %8s\n' "everything else, $kind" $(seconds cmake --build "$tree" -- -j2)
  touch "$header"
  printf '%-34s %8s %8s\n' "after $(basename $header), $kind" $(seconds cmake --build "$tree" -- -j2)
done
