#!/usr/bin/env python3
"""How far each setting moves routes and joules: settings.py [TALUS], on three generated sites, as a Markdown table.

The route of each setting is compared with that of the defaults: its energy and length by its own summary, and its
greatest distance from the other route."""
import json
import math
import subprocess
import sys
import tempfile

SITES = {"craters": (7, "30,30", "350,330", []), "dunes": (31, "100,40", "330,330", ["--rover", "mer"]),
         "rocks": (3, "30,30", "330,350", ["--rover", "mer"])}
SETTINGS = [("cell size 2 m", ["--resolution", "2"]), ("footprint half", ["--footprint", "0.5"]),
            ("footprint double", ["--footprint", "1.6"]), ("slope uncertainty 0 deg", ["--slope-uncertainty-deg", "0"]),
            ("slope uncertainty 8 deg", ["--slope-uncertainty-deg", "8"]), ("risk weight / 10", ["--risk-weight", "1e7"]),
            ("risk weight x 10", ["--risk-weight", "1e9"]), ("entrapment 1", ["--entrapment", "1"]),
            ("slip not monitored", ["--unmonitored"]), ("time weight 0", ["--time-weight", "0"]),
            ("time weight 20 W", ["--time-weight", "20"]), ("pose error 2 m", ["--pose-error", "2"]),
            ("no marginal ground", ["--no-marginal"])]


def planned(talus, folder, site, more):
    _, start, goal, rover = SITES[site]
    run = subprocess.run([talus, "--json", "--quiet", "--force", "plan", f"{site}.tif", "--terrain", f"{site}_classes.tif",
                          "--soils", f"{site}_soils.yaml", "--start", start, "--goal", goal, "-o", "r.geojson",
                          *rover, *more], cwd=folder, capture_output=True, text=True)
    if run.returncode != 0:
        return None
    with open(f"{folder}/r.geojson", encoding="utf-8") as file:
        properties = json.load(file)["features"][0]["properties"]
    return json.loads(run.stdout), list(zip(properties["x_m"], properties["y_m"]))


def text(site, default, other):
    if other is None:
        return "no route"
    (before, way), (after, line) = default, other
    apart = max(min(math.dist(p, q) for q in way) for p in line)
    change = [100.0 * (after[key] / before[key] - 1.0) for key in ("energy_J", "length_m")]
    return f"{change[0]:+.1f} %, {change[1]:+.1f} %, {apart:.0f} m"


def main():
    talus = sys.argv[1] if len(sys.argv) > 1 else "talus"
    with tempfile.TemporaryDirectory() as folder:
        rows = {name: [] for name, _ in SETTINGS}
        for site, (seed, *_) in SITES.items():
            subprocess.run([talus, "--quiet", "--seed", str(seed), "generate", site, "--size", "400", "-o", f"{site}.tif"],
                           cwd=folder, check=True)
            default = planned(talus, folder, site, [])
            for name, more in SETTINGS:
                rows[name].append(text(site, default, planned(talus, folder, site, more)))
    print("| setting | " + " | ".join(SITES) + " |\n|" + "---|" * (len(SITES) + 1))
    for name, cells in rows.items():
        print(f"| {name} | " + " | ".join(cells) + " |")


main()
