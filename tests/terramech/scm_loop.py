#!/usr/bin/env python3
"""Tracing on wheels of another engine's soil: scm_loop.py DATA [TALUS].

DATA is ../shared/data/scm_wheel. The true soil is declared. Designed runs with sensor noise are traced; random runs without
noise are predicted by the base and by the refined model. Prints the errors, the share of readings within two standard deviations, and
what is named."""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

BASE = """soil: {cohesion_Pa: 2000, friction_angle_deg: 28, sinkage_exponent: 0.8, cohesive_modulus: 5000,
  frictional_modulus: 800000, shear_modulus_m: 0.025, c1: 0.18, c2: 0.32}
model: wong-reece
sensors: {load_N: 2.4, slip: 0.01, torque_Nm: 0.1, sinkage_m: 0.0004, drawbar_pull_N: 1.2}
"""
ANSWERS = ("drawbar_pull_N", "sinkage_m", "torque_Nm", "side_force_N")
COLUMNS = ("run", "load_N", "slip", "wheel_radius_m", "wheel_width_m", "speed_mps", "pass_index", "grouser_height_m",
           "grouser_count", "slip_angle_rad") + ANSWERS


def rows_of(path):
    return [{k: v for k, v in row.items() if k in COLUMNS} for row in csv.DictReader(open(path))]


def write(path, rows):
    names = [name for name in COLUMNS if any(name in row for row in rows)]
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)


def errors(rows, predicted):
    off, within = {}, []
    for row, p in zip(rows, csv.DictReader(open(predicted))):
        for answer in ANSWERS[:3]:
            scale = float(row["load_N"]) if answer == "drawbar_pull_N" else float(row["wheel_radius_m"])
            scale *= float(row["load_N"]) if answer == "torque_Nm" else 1.0
            error = float(p["predicted_" + answer]) - float(row[answer])
            off.setdefault(answer, []).append(error / scale)
            within.append(abs(error) <= 2.0 * float(p["predicted_" + answer + "_std"]))
    rms = ", ".join(f"{math.sqrt(sum(e * e for e in v) / len(v)):.4f}" for v in off.values())
    return f"DP/W, z/r, T/(rW) {rms}; within {sum(within) / len(within):.3f}"


def loop(talus, what, seen, unseen):
    with tempfile.TemporaryDirectory() as work:
        base, model, table, blank, out = (os.path.join(work, n) for n in ("b.yaml", "m.yaml", "t.csv", "u.csv", "o.csv"))
        open(base, "w").write(BASE)
        write(table, seen)
        write(blank, [{k: v for k, v in row.items() if k not in ANSWERS} for row in unseen])
        done = subprocess.run([talus, "trace", table, "--base", base, "--model-out", model, "--json", "--quiet"],
                              capture_output=True, text=True)
        story = json.loads(done.stdout)
        print(f"{what}: {len(seen)} rows traced, {len(unseen)} predicted: {story['verdict']}")
        for name, path in (("base", base), ("refined", model)):
            subprocess.run([talus, "predict", blank, "--model", path, "-o", out, "--quiet"], check=True, capture_output=True)
            print(f"  {name:8s}{errors(unseen, out)}")
    for e in story["effects"]:
        equal = "".join(f" = {o['name']} ({o['covariate']})" for o in e["equal_to"])
        print(f"  {e['name']} ({e['covariate']}){equal}")
    sys.stdout.flush()


def main():
    if len(sys.argv) < 2:
        sys.exit("scm_loop.py DATA [TALUS]: DATA is missing, the folder of scm_loam_pass1.csv and the other tables")
    data = sys.argv[1]
    talus = sys.argv[2] if len(sys.argv) > 2 else "build/release/cli/talus"
    noisy = {name: rows_of(f"{data}/noisy/scm_loam_{name}.csv") for name in
             ("pass1", "wheels", "passes", "passes_in_rut", "grousers", "angles", "bulldozing", "random", "random_angles")}
    random = rows_of(f"{data}/scm_loam_random.csv")
    loop(talus, "pass1, random kept back", noisy["pass1"], random)
    loop(talus, "wheels, random kept back", noisy["wheels"], random)
    loop(talus, "pass1 and wheels, random kept back", noisy["pass1"] + noisy["wheels"], random)
    for name in list(noisy)[2:]:
        loop(talus, name + ", without noise", noisy[name], rows_of(f"{data}/scm_loam_{name}.csv"))
    for name in ("wheels", "random", "passes", "grousers"):
        loop(talus, name + ", slip above 0.4 kept back", [r for r in noisy[name] if float(r["slip"]) <= 0.4],
             [r for r in noisy[name] if float(r["slip"]) > 0.4])


if __name__ == "__main__":
    main()
