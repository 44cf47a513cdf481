#!/usr/bin/env python3
"""Rates of docs/simulation.md: three kinds of trap at three densities, and each sensor fault.

simulation_table.py PROGRAM FOLDER [WORLDS] [FIRST_SEED] [FAULT ...]

Each ten worlds of a cell of the table are a file in FOLDER that is kept: stopped, or called with more worlds, it goes on with
what is missing. FAULT restricts the table to its rows; "none" is those of the densities. Intervals are of 95 %: Wilson's for rates, of the mean over worlds for energy.
"""
import collections
import json
import math
import pathlib
import subprocess
import sys

TRAPS = {"as published": (24, 300000), "softer": (22, 150000), "carries no wheel": (22, 20000)}
DENSITIES = (5, 10, 20)
FAULTS = ("slip_stuck", "slip_biased", "odometry_stuck", "torque_offset", "sinkage_datum", "silent", "pose_displaced")


def truth(trap, patches):
    friction_deg, modulus = TRAPS[trap]
    return f"""random: {{spread: 0.1, patches: {patches}, patch_radius_m: 3, patch_soil: trap}}
soils:
  - {{name: trap, cohesion_kPa: 0, friction_angle_deg: {friction_deg}, sinkage_exponent: 1, cohesive_modulus: 1400,
     frictional_modulus: {modulus}, shear_modulus_mm: 15}}
"""


CHUNK = 10  # worlds a call


def mean_interval(values):
    if len(values) < 2:
        return "-"
    mean = sum(values) / len(values)
    half = 1.96 * math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))
    return f"{mean:.3f} [{mean - half:.3f}, {mean + half:.3f}]"


def wilson(hits, n):
    if n == 0:
        return "-"
    z = 1.959964
    p = hits / n
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return f"{100 * p:.1f} % [{100 * max(middle - half, 0):.1f}, {100 * (middle + half):.1f}]"


class Cells:
    def __init__(self, program, folder, worlds, seed):
        self.program, self.folder, self.worlds, self.seed = program, pathlib.Path(folder).resolve(), worlds, seed
        self.folder.mkdir(parents=True, exist_ok=True)
        if not (self.folder / "site.tif").exists():
            self.run("generate", "rocks", "--size", "160", "--resolution", "0.5", "-o", "site.tif")

    def run(self, *words):
        return subprocess.run([self.program, *words], cwd=self.folder, capture_output=True, text=True, check=True).stdout

    def worlds_of(self, trap, patches, belief, fault="none"):
        firsts = range(self.seed, self.seed + self.worlds, CHUNK)
        return [world for first in firsts for world in self.chunk(trap, patches, belief, fault, first)]

    def chunk(self, trap, patches, belief, fault, first):
        worlds = min(CHUNK, self.seed + self.worlds - first)
        name = f"{trap} {patches} {belief} {fault} {first} {worlds}".replace(" ", "_")
        path = self.folder / (name + ".json")
        if not path.exists():
            (self.folder / "truth.yaml").write_text(truth(trap, patches))
            out = self.run("drive", "site.tif", "--soil", "sandy_loam", "--rover", "sojourner", "--truth", "truth.yaml",
                           "--start", "8,8", "--goal", "72,72", "--worlds", str(worlds), "--seed", str(first),
                           "--belief", belief, "--fault", fault, "--threads", "1", "--json", "--quiet")
            path.with_suffix(".part").write_text(out)
            path.with_suffix(".part").rename(path)
        return json.loads(path.read_text())["each"]

    def row(self, trap, patches, fault="none"):
        """Counted where perfect knowledge reached the goal; energy where both did."""
        best = self.worlds_of(trap, patches, "perfect-knowledge")
        mine = self.worlds_of(trap, patches, "online", fault)
        safe = [(m, b) for m, b in zip(mine, best) if b["outcome"] == "reached"]
        count = collections.Counter(m["outcome"] for m, _ in safe)
        ratios = [m["energy_J"] / b["energy_J"] for m, b in safe if m["outcome"] == "reached"]
        causes = collections.Counter(m["cause"].split(";")[0] + ";" + m["cause"].split(";")[1]
                                     for m, _ in safe if m["outcome"] == "immobilised")
        return (f"| {trap} | {patches} | {fault} | {len(safe)} | {wilson(count['immobilised'], len(safe))} | "
                f"{wilson(count['gave_up'], len(safe))} | {mean_interval(ratios)} |"), causes


def main():
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    cells = Cells(program, folder, int(sys.argv[3]) if len(sys.argv) > 3 else 300,
                  int(sys.argv[4]) if len(sys.argv) > 4 else 600001)
    print("| trap | patches | fault | worlds with a safe route | immobilised | no route found | energy over perfect knowledge |")
    print("|---|---|---|---|---|---|---|")
    losses = collections.Counter()
    for trap, patches, fault in ([(t, d, "none") for t in TRAPS for d in DENSITIES] +
                                 [(t, 10, f) for t in TRAPS for f in FAULTS]):
        if sys.argv[5:] and fault not in sys.argv[5:]:
            continue
        line, causes = cells.row(trap, patches, fault)
        print(line, flush=True)
        for cause, n in causes.items():
            losses[f"{trap}, {fault}: {cause}"] += n
    print("\nLosses:")
    for cause, n in losses.most_common():
        print(f"{n:5d}  {cause}")


if __name__ == "__main__":
    main()
