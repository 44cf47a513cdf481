#!/usr/bin/env bash
# Fuzzes each target MINUTES long by libFuzzer, then the program's calls for as long; goes on where it stopped.
#
#   tests/fuzz/run.sh BUILD TALUS [MINUTES] [TARGET...]
#
# BUILD is a build of the preset `fuzz`, TALUS the program or call_server. BUILD/fuzzing keeps what was found interesting
# (corpus/TARGET), what failed (faults/TARGET-*; give one to BUILD/tests/fuzz/fuzz_MODULE with TALUS_FUZZ_TARGET set), the
# number of the next call (calls), what calls said (calls.txt) and a line a run (runs.txt). Ends with 1 where anything failed.
set -euo pipefail
build=$1 talus=$2 minutes=${3:-10}
shift $(($# < 3 ? $# : 3))
wanted=("$@")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
state=$build/fuzzing
mkdir -p "$state/faults"
failed=0

is_wanted() { [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $1 "* ]]; }
note() { printf '%s\n' "$*" | tee -a "$state/runs.txt"; }

for module in terramech maps costmap planner cli; do
  program=$build/tests/fuzz/fuzz_$module
  for target in $("$program"); do
    is_wanted "$target" || continue
    corpus=$state/corpus/$target
    mkdir -p "$corpus"
    export TALUS_FUZZ_TARGET=$target
    TALUS_FUZZ_SEEDS=$corpus "$program" -runs=0 "$corpus" 2>/dev/null
    fault=0
    "$program" -max_total_time=$((minutes * 60)) -timeout=20 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
      -dict="$here/dictionaries/$target.dict" -artifact_prefix="$state/faults/$target-" "$corpus" \
      >"$state/$target.log" 2>&1 || fault=1
    inputs=$(awk '/stat::number_of_executed_units/ {print $2}' "$state/$target.log")
    edges=$(grep -o 'cov: [0-9]*' "$state/$target.log" | tail -1 || true)
    note "$target: ${inputs:-?} inputs, $edges, $fault faults"
    [ $fault -eq 0 ] || { failed=1; tail -5 "$state/$target.log"; }
    unset TALUS_FUZZ_TARGET
  done
done

if is_wanted calls; then
  next=$(cat "$state/calls" 2>/dev/null || echo 0)
  stretch=500
  begin=$SECONDS
  while [ $((SECONDS - begin)) -lt $((minutes * 60)) ]; do
    "$here/mutate_calls.py" "$talus" $stretch "$next" | tee -a "$state/calls.txt" || failed=1
    next=$((next + stretch))
    echo "$next" >"$state/calls"
  done
  note "calls: 0 to $next"
fi
exit $failed
