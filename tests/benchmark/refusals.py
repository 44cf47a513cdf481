#!/usr/bin/env python3
"""Random pairs on elevation maps: how many have a route, how many are proven to have none and why, how many are neither.

refusals.py [--against GRID.so] PROGRAM PAIRS SEED SOIL DEM...     for rovers mer and lunar_micro

Places are drawn among those that the rover may stand on; what cannot be a start or a goal is drawn anew. With --against every
refused pair is given to a grid of 80 directions (the target direction_grid) and, where nothing was proven, to ABITstar for 10 s; a
route of theirs that `talus score` accepts is named.
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
            places = [[draw.uniform(*info[axis]) for axis in ("x_m", "y_m", "x_m", "y_m")] for _ in range(2 * pairs)]
            lines = ["start_x_m,start_y_m,goal_x_m,goal_y_m"] + [",".join(map(str, p)) for p in places]
            table.write_text("\n".join(lines) + "\n")
            answers = run(program, "plan", dem, "--rover", rover, "--soil", soil, "--pairs", str(table), "--json", "--quiet", *ground)
        for answer, place in zip(answers, places):
            answer["places"] = f"{place[0]},{place[1]}", f"{place[2]},{place[3]}"
        kept += [a for a in answers if a["status"] not in ("start_invalid", "goal_invalid")]
        if len(kept) >= pairs:
            return kept[:pairs]
    return kept


def found_otherwise(program, grid, dem, words, answer):
    """Another search that finds a route which score accepts; None if none does."""
    ways = {"grid80": ("--plugin", grid)}
    if answer["status"] == "none_found":
        ways["ABITstar"] = ("--planner", "ABITstar", "--time", "10")
    start, goal = answer["places"]
    with tempfile.TemporaryDirectory() as folder:
        route = f"{folder}/route.geojson"
        for name, how in ways.items():
            found = run(program, "plan", dem, *words, "--start", start, "--goal", goal, "--json", "--quiet", "--force", "-o", route, *how)
            if found["status"] == "found" and not run(program, "score", dem, *words, "--path", route, "--json")["violations"]:
                return name
    return None


def main():
    grid = None
    if sys.argv[1:2] == ["--against"]:
        grid = sys.argv[2]
        del sys.argv[1:3]
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
            for answer in answers if grid else ():
                if answer["status"] in ("no_route", "none_found"):
                    other = found_otherwise(program, grid, dem, ["--rover", rover, "--soil", soil, *ground], answer)
                    print(f"  {answer['status']} {' '.join(answer['places'])}: {other or 'no other search'} finds a route", flush=True)


if __name__ == "__main__":
    main()
