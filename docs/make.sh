#!/usr/bin/env bash
# docs/make.sh TALUS: generates the figures of docs/: the validation page, and the README's picture from the demo.
set -euo pipefail
talus=$(realpath "${1:?usage: docs/make.sh PATH_TO_TALUS}")
cd "$(dirname "$0")"
"$talus" reproduce -o . ${TALUS_MEASURED_DATA:+--measured "$TALUS_MEASURED_DATA/single_wheel_digitised/points.csv"}
demo=$(mktemp -d)
trap 'rm -rf "$demo"' EXIT
./demo.sh "$talus" "$demo"
cp "$demo/moon.png" route.png
