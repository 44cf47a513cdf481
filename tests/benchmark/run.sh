#!/usr/bin/env bash
# Runs every benchmark of a build folder: tests/benchmark/run.sh BUILD [google-benchmark options]
set -euo pipefail
build=$1
shift
for program in "$build"/tests/benchmark/*_benchmark; do
  [ -x "$program" ] || continue
  printf '\n== %s\n' "$(basename "$program")"
  "$program" "$@"
done
