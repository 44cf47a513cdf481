#!/usr/bin/env python3
"""Residual tracing on tables whose effects are known: keyed_trials.py FOLDER [TALUS] [TABLE ...].

FOLDER holds datasets/NAME.csv and heldout.json, declared/NAME.json (soil, sensors), key/key.json (effects, floor).
Each table is traced on the runs not held out, its soil known to 10 %, and the model predicts the held-out runs.
Prints a line a table and the rates; numbers of tables alone judge nothing else than these tables."""
import csv
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

COLUMN = {"load": "load_N", "slip": "slip", "sinkage": "sinkage_m", "torque": "torque_Nm", "time": "time_s",
          "speed": "speed_mps", "slope": "slope_rad", "grouser_height": "grouser_height_m", "pass_index": "pass_index",
          "wheel_width": "wheel_width_m", "wheel_radius": "wheel_radius_m", "run": "run"}
TWINS = {"rim_speed_mps": "speed_mps"}


def base_file(declared, path):
    soil, sensor = declared["nominal"], declared["sensor_sigma"]

    def known(field, value):
        return f"  {field}: {{mean: {value}, std: {0.1 * abs(value)}}}\n"

    text = "soil:\n" + known("cohesion_Pa", soil["c_Pa"]) + known("friction_angle_rad", soil["phi_rad"])
    text += known("sinkage_exponent", soil["n"]) + known("cohesive_modulus", soil["kc"])
    text += known("frictional_modulus", soil["kphi"]) + known("shear_modulus_m", soil["K_m"])
    text += f"  c1: {declared['c1']}\n  c2: {declared['c2']}\n"
    text += f"sensors: {{load_N: {sensor['W']}, slip: {sensor['i']}, torque_Nm: {sensor['T']}, "
    text += f"sinkage_m: {sensor['z']}, drawbar_pull_N: {sensor['DP']}}}\n"
    open(path, "w").write(text)


def judge(folder, talus, name, key, held):
    rows = list(csv.DictReader(open(f"{folder}/datasets/{name}.csv")))
    with tempfile.TemporaryDirectory() as work:
        base, model, seen, unseen, out = (os.path.join(work, n) for n in ("b.yaml", "m.yaml", "s.csv", "u.csv", "o.csv"))
        base_file(json.load(open(f"{folder}/declared/{name}.json")), base)
        truth = []
        for path, wanted in ((seen, False), (unseen, True)):
            with open(path, "w", newline="") as file:
                writer = csv.DictWriter(file, rows[0].keys())
                writer.writeheader()
                for row in rows:
                    if (int(float(row["run"])) in held) != wanted:
                        continue
                    if wanted:
                        truth.append((float(row["drawbar_pull_N"]), float(row["load_N"])))
                        row = dict(row, drawbar_pull_N="")
                    writer.writerow(row)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([talus, "trace", seen, "--base", base, "--model-out", model, "--json", "--quiet",
                               "--threads", "1"], capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        story = json.loads(done.stdout)
        subprocess.run([talus, "predict", unseen, "--model", model, "-o", out, "--quiet"], check=True, capture_output=True)
        error, within = [], 0
        for (pull, load), row in zip(truth, csv.DictReader(open(out))):
            off = float(row["predicted_drawbar_pull_N"]) - pull
            error.append(off / load)
            within += abs(off) <= 2.0 * float(row["predicted_drawbar_pull_N_std"])
    claimed = [e["covariate"] for e in story["effects"]]
    columns = {TWINS.get(c, c) for c in claimed}
    found = [bool(columns & {COLUMN[c] for c in e["acceptable_covariates"]}) for e in key["effects"]]
    rms = math.sqrt(sum(e * e for e in error) / len(error))
    return {"found": found, "claims": [f"{e['name']}({e['covariate']})" for e in story["effects"]],
            "ratio": rms / key["floor"]["realised_heldout_forward"], "within": within / len(error),
            "cpu": after.ru_utime - before.ru_utime, "verdict": story.get("verdict", "")}


def main():
    folder = sys.argv[1]
    talus = sys.argv[2] if len(sys.argv) > 2 else "build/release/cli/talus"
    keys = json.load(open(f"{folder}/key/key.json"))
    held = json.load(open(f"{folder}/datasets/heldout.json"))
    single = [0, 0]
    both = [0, 0]
    alarms = [0, 0]
    ratios, shares, slowest = [], [], 0.0
    for name in sys.argv[3:] or sorted(keys):
        r = judge(folder, talus, name, keys[name], held[name])
        true = ",".join("/".join(e["acceptable_covariates"]) for e in keys[name]["effects"]) or keys[name]["null_kind"]
        print(f"{name} {true:36s} {''.join('+' if f else '-' for f in r['found']):2s} {' '.join(r['claims']) or 'none'}"
              f"  error/floor {r['ratio']:.2f}, within {r['within']:.2f}, {r['cpu']:.1f} s {r['verdict']}", flush=True)
        tally, hit = ((alarms, bool(r["claims"])) if not r["found"] else
                      (single if len(r["found"]) == 1 else both, all(r["found"])))
        tally[0] += hit
        tally[1] += 1
        ratios.append(r["ratio"])
        shares.append(r["within"])
        slowest = max(slowest, r["cpu"])
    print(f"one effect named {single[0]} of {single[1]}; both of two {both[0]} of {both[1]}; "
          f"alarms {alarms[0]} of {alarms[1]}")
    ratios.sort()
    print(f"held-out error over floor: median {ratios[len(ratios) // 2]:.2f}, worst {ratios[-1]:.2f}; "
          f"within two standard deviations {sum(shares) / len(shares):.3f}; slowest {slowest:.1f} s of CPU")


if __name__ == "__main__":
    main()
