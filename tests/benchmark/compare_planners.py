#!/usr/bin/env python3
"""The field's route against the best route known: every planner of routes with a time limit, and a grid of 80 directions.

compare_planners.py PROGRAM GRID.so SECONDS PAIRS SEED MAP...

MAP is craters, dunes or rocks (generated, 300 x 300 cells, seed SEED), FILE, or FILE:RESOLUTION without a CRS.
GRID.so is the target direction_grid. Every route is scored by `talus score`; one with a violation does not count and is named.
A refused pair is also given to the other planners. Writes a table by pair and the median and worst of each map.
"""
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

OTHERS = ("RRTstar", "InformedRRTstar", "BITstar", "ABITstar", "SST", "FMT")


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode > 1 and not done.stdout.strip():
        raise SystemExit(done.stderr.strip())
    return json.loads(done.stdout) if done.stdout.strip() else {"status": "none"}


class Site:
    def __init__(self, program, name, seed, folder):
        self.program, self.name = program, pathlib.Path(name).name
        self.words = ["--rover", "mer"]
        if name in ("craters", "dunes", "rocks"):
            self.dem = str(folder / f"{name}.tif")
            run(program, "generate", name, "--size", "300", "--seed", str(seed), "-o", self.dem, "--quiet", "--json")
            base = folder / name
            self.words += ["--terrain", f"{base}_classes.tif", "--soils", f"{base}_soils.yaml", "--rocks", f"{base}_rocks.tif"]
            info = run(program, "info", self.dem, "--json")
        else:
            ground = []
            if ":" in name and not pathlib.Path(name).exists():
                name, resolution = name.rsplit(":", 1)
                ground = ["--resolution", resolution]
            self.dem = name
            self.words += ["--soil", "mars_blocky", *ground]
            info = run(program, "info", name, "--json", *ground)
        self.x_m, self.y_m, self.resolution_m = info["x_m"], info["y_m"], info["resolution_m"]

    def drawn(self, draw):
        return f"{draw.uniform(*self.x_m)},{draw.uniform(*self.y_m)}"

    def plan(self, start, goal, route, *how):
        return run(self.program, "plan", self.dem, *self.words, "--start", start, "--goal", goal, "--json", "--quiet", "-o", route, *how)

    def score(self, route):
        return run(self.program, "score", self.dem, *self.words, "--path", route, "--json")


def close_vertices(route, resolution_m):
    """Pairs of neighbouring vertices closer than a hundredth of a cell."""
    at = json.loads(pathlib.Path(route).read_text())["features"][0]["properties"]
    points = list(zip(at["x_m"], at["y_m"]))
    return sum(math.dist(a, b) < 0.01 * resolution_m for a, b in zip(points, points[1:]))


def costs(site, start, goal, grid, seconds, folder, first):
    """Scored cost by planner; what has none is left out."""
    found = {}
    ways = {name: ("--planner", name, "--time", seconds) for name in OTHERS}
    ways["grid80"] = ("--plugin", grid)
    for name, how in {"field": (), **ways}.items():
        route = str(folder / f"{name}.geojson")
        answer = first if name == "field" else site.plan(start, goal, route, "--force", *how)
        if answer["status"] != "found":
            continue
        close = close_vertices(route, site.resolution_m)
        if close:
            print(f"vertices closer than a hundredth of a cell: {site.name} {start} {goal} {name}: {close}", flush=True)
        scored = site.score(route)
        if scored["violations"]:
            print(f"violations: {site.name} {start} {goal} {name}: {scored['violations'][0]}", flush=True)
            continue
        found[name] = scored["cost"]
    return found


def main():
    if len(sys.argv) < 7:
        raise SystemExit(__doc__)
    program, grid, seconds, pairs, seed, names = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), int(sys.argv[5]), sys.argv[6:]
    rows, missed, refused = [], 0, 0
    print("| map | pair | field, kJ | best, kJ | by | field over best, % | status |\n|---|---|---|---|---|---|---|")
    for name in names:
        with tempfile.TemporaryDirectory() as made:
            folder = pathlib.Path(made)
            site, draw, kept = Site(program, name, seed, folder), random.Random(seed), 0
            for _ in range(50 * pairs):
                if kept == pairs:
                    break
                start, goal = site.drawn(draw), site.drawn(draw)
                first = site.plan(start, goal, str(folder / "field.geojson"), "--force")
                if first["status"] in ("start_invalid", "goal_invalid"):
                    continue
                kept += 1
                found = costs(site, start, goal, grid, seconds, folder, first)
                if "field" not in found:
                    refused += 1
                    missed += bool(found)
                    print(f"| {site.name} | {kept} | - | {min(found.values(), default=0) / 1e3 if found else '-'} | {' '.join(found) or '-'} | - | {first['status']} |", flush=True)
                    continue
                best = min(found, key=found.get)
                over = 100 * (found["field"] / found[best] - 1)
                rows.append((site.name, over))
                print(f"| {site.name} | {kept} | {found['field'] / 1e3:.2f} | {found[best] / 1e3:.2f} | {best} | {over:.2f} | found |", flush=True)
    print("\n| map | pairs | median, % | worst, % |\n|---|---|---|---|")
    for name in dict.fromkeys(name for name, _ in rows):
        own = [over for other, over in rows if other == name]
        print(f"| {name} | {len(own)} | {statistics.median(own):.2f} | {max(own):.2f} |")
    every = [over for _, over in rows]
    if every:
        print(f"| all | {len(every)} | {statistics.median(every):.2f} | {max(every):.2f} |")
    print(f"\n{refused} pairs without a route of the field, {missed} of them with one of another planner")


if __name__ == "__main__":
    main()
