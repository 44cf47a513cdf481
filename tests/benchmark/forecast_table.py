#!/usr/bin/env python3
"""Table "Forecast against driven worlds" of docs/slopes.md.

forecast_table.py PROGRAM MAPS FOLDER [WORLDS]

MAPS holds the real maps; without it their rows are left out. Each row that is complete is a file in FOLDER that is kept.
The last column is the error of the slip along the route where the truth is the mean soil.
"""
import json
import math
import pathlib
import re
import subprocess
import sys

HILL = (pathlib.Path(__file__).resolve().parents[2] / "examples/hill.asc", 1, ("--resolution", "1"))
MER = ("--rover", "mer", "--soil")
ROWS = (  # site, its cell in metres, options, start, goal
    (*HILL, ("--rover", "fido", "--soil", "sandy_loam"), "24.02,4.57", "0.66,20.77"),
    (*HILL, ("--rover", "fido", "--soil", "sandy_loam"), "12.30,8.62", "36.09,7.20"),
    ("craters", 1, (), (*MER, "lunar_nominal"), "54.56,19.97", "142.29,13.43"),
    ("craters", 1, (), (*MER, "lunar_nominal"), "80.93,65.39", "45.15,85.81"),
    ("rocks", 1, (), (*MER, "mars_crusty"), "52.47,24.12", "137.42,141.68"),
    ("rocks", 1, (), (*MER, "mars_crusty"), "27.33,118.48", "5.84,34.66"),
    ("moon_lola_npc_2km_5m.tif", 5, (), (*MER, "lunar_nominal"), "127170.23,-92069.93", "127259.69,-92179.33"),
    ("moon_lola_npc_2km_5m.tif", 5, (), (*MER, "lunar_nominal"), "127683.25,-93228.10", "127735.68,-93268.67"),
    ("mars_gale_hirise_1m.tif", 1, (), (*MER, "mars_crusty"), "8142495.75,-276648.32", "8142522.26,-276730.83"),
    ("mars_gale_hirise_1m.tif", 1, (), (*MER, "mars_crusty"), "8142620.06,-276597.71", "8142634.28,-276568.88"),
)


def main(program, maps, folder, worlds):
    folder = pathlib.Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mean.yaml").write_text("{}\n")
    (folder / "believed.yaml").write_text("random: {as_believed: true}\n")

    def run(*words):
        return subprocess.run([program, *map(str, words), "--quiet"], cwd=folder, capture_output=True, text=True, check=True).stdout

    for number, (name, cell, reading, ground, start, goal) in enumerate(ROWS):
        site = pathlib.Path(maps) / name if str(name).endswith(".tif") else pathlib.Path(name)
        if not site.suffix:
            site = folder / f"{name}.tif"
            if not site.exists():
                run("generate", name, "--size", 160, "--seed", 9006, "-o", site)
        if not site.exists():
            continue
        kept = folder / f"row{number}_{worlds}.json"
        if not kept.exists():
            ends = (site, *reading, *ground, f"--start={start}", f"--goal={goal}")
            drive = ("drive", *ends, "--belief", "prior", "--pose-drift", 0, "--truth")
            plan = json.loads(run("plan", *ends, "--no-proof", "--tolerance", cell, "-o", "route.geojson", "--json"))
            each = json.loads(run(*drive, "believed.yaml", "--worlds", worlds, "--threads", 1, "--json"))["each"]
            slip = float(re.search(r"slip error ([0-9.]+) rms", run(*drive, "mean.yaml")).group(1))
            kept.write_text(json.dumps({"plan": plan, "each": each, "slip": slip}))
        row = json.loads(kept.read_text())
        plan, driven = row["plan"], [w for w in row["each"] if w["outcome"] == "reached"]
        mean = {key: sum(w[key] for w in driven) / len(driven) for key in ("energy_J", "time_s")}
        over = [100 * (plan[key] / mean[key] - 1) for key in mean]
        error = 100 * math.sqrt(sum((w["energy_J"] / mean["energy_J"] - 1) ** 2 for w in driven)) / len(driven)
        within = sum(w["energy_J"] <= plan["energy_p90_J"] for w in driven) / len(driven)
        print(f"| {site.name} | {start} to {goal} | {len(driven)} of {len(row['each'])} | {over[0]:+.1f} +- {error:.1f} % | {over[1]:+.1f} % | {within:.2f} | {row['slip']:.3f} |", flush=True)


main(*sys.argv[1:4], int(sys.argv[4]) if len(sys.argv) > 4 else 200)
