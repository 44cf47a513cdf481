#!/usr/bin/env python3
"""Random pairs on elevation maps: how many have a route, how many are proven to have none and why, how many are neither.

refusals.py PROGRAM PAIRS SEED SOIL DEM...     for rovers mer and lunar_micro

Places are drawn among those that the rover may stand on; what cannot be a start or a goal is drawn anew.
"""
import collections
import json
import pathlib
import random
import subprocess
import sys
import tempfile

ROVERS = ("mer", "lunar_micro")


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode > 1:
        raise SystemExit(done.stderr.strip())
    return json.loads(done.stdout)


def outcomes(program, dem, rover, soil, pairs, draw, ground):
    """The answers for so many pairs whose ends stand."""
    info = run(program, "info", dem, "--json", *ground)
    kept = []
    for _ in range(20):
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "pairs.csv"
            lines = ["start_x_m,start_y_m,goal_x_m,goal_y_m"]
            for _ in range(2 * pairs):
                lines.append(",".join(str(draw.uniform(*info[axis])) for axis in ("x_m", "y_m", "x_m", "y_m")))
            table.write_text("\n".join(lines) + "\n")
            answers = run(program, "plan", dem, "--rover", rover, "--soil", soil, "--pairs", str(table), "--json", "--quiet", *ground)
        kept += [a for a in answers if a["status"] not in ("start_invalid", "goal_invalid")]
        if len(kept) >= pairs:
            return kept[:pairs]
    return kept


def main():
    if len(sys.argv) < 6:
        raise SystemExit(__doc__)
    program, pairs, seed, soil, dems = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4], sys.argv[5:]
    print("| map | rover | found | no route (proven): closed by | none found |\n|---|---|---|---|---|")
    for dem in dems:
        ground = []
        if ":" in dem and not pathlib.Path(dem).exists():  # FILE:RESOLUTION for a map without a CRS
            dem, resolution = dem.rsplit(":", 1)
            ground = ["--resolution", resolution]
        for rover in ROVERS:
            answers = outcomes(program, dem, rover, soil, pairs, random.Random(seed), ground)
            count = collections.Counter(a["status"] for a in answers)
            why = collections.Counter((a.get("obstruction") or {}).get("lifting") or "several" for a in answers if a["status"] == "no_route")
            closed = ", ".join(f"{n} {name}" for name, n in why.most_common()) or "-"
            print(f"| {pathlib.Path(dem).name} | {rover} | {count['found']} | {count['no_route']}: {closed} | {count['none_found']} |", flush=True)


if __name__ == "__main__":
    main()
