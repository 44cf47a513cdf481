#!/usr/bin/env python3
"""Held-out errors of residual tracing beside a Gaussian process: gaussian_process.py TABLE.csv TALUS REQUEST...

Each REQUEST is a --hold-out of `talus trace` (COLUMN, COLUMN=V,V or COLUMN=LOW..HIGH). The process has a squared exponential
kernel over slip, slip angle and grouser height, one length each, noise and amplitude by maximum likelihood (Rasmussen and Williams
2006, chapter 5), a constant mean, and is fitted to the same rows; it knows no wheel. Needs python3-scipy. Prints rmse over all rows held out."""
import csv
import json
import subprocess
import sys

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

FEATURES = ["slip", "slip_angle_rad", "grouser_height_m"]
CHANNELS = ["drawbar_pull_over_load", "sinkage_over_radius", "side_force_over_load"]


def kernel(a, b, log):
    return np.exp(2.0 * log[0]) * np.exp(-0.5 * sum(((a[:, None, k] - b[None, :, k]) * np.exp(-log[k + 2])) ** 2
                                                    for k in range(a.shape[1])))


def predict(x, y, at):
    mean, scale = y.mean(), y.std()
    spread = np.where(x.std(axis=0) > 0.0, x.std(axis=0), 1.0)
    x, at, y = x / spread, at / spread, (y - mean) / scale

    def system(log):
        return cho_factor(kernel(x, x, log) + (np.exp(2.0 * log[1]) + 1e-8) * np.eye(len(x)), lower=True)

    def loss(log):
        if np.any(np.abs(log) > 6.0):
            return 1e12
        factor = system(log)
        return 0.5 * y @ cho_solve(factor, y) + np.log(np.diag(factor[0])).sum()

    starts = [[0.0, noise] + [length] * x.shape[1] for noise in (-1.0, -3.0) for length in (0.0, 1.0)]
    best = min((minimize(loss, start, method="Nelder-Mead", options={"maxiter": 600}) for start in starts), key=lambda fit: fit.fun)
    return mean + scale * kernel(at, x, best.x) @ cho_solve(system(best.x), y)


def parts(rows, request):
    """The rows of each part that --hold-out names, as bit masks."""
    column, _, values = request.partition("=")
    numbers = None
    if rows[0][column].replace(".", "").replace("-", "").replace("e", "").isdigit():
        numbers = np.array([float(row[column]) for row in rows])
    if ".." in values:
        low, high = values.split("..")
        return [(numbers >= float(low or "-inf")) & (numbers <= float(high or "inf"))]
    if numbers is None:
        words = values.split(",") if values else sorted({row[column] for row in rows})
        return [np.array([row[column] == word for row in rows]) for word in words]
    if values:
        return [np.min([np.abs(numbers - float(v)) for v in values.split(",")], axis=0) < 1e-3 * (1.0 + np.abs(numbers))]
    order, apart, masks = np.sort(numbers), 0.01 * np.ptp(numbers), []
    for value in order:
        if masks and value - masks[-1][1] <= apart:
            masks[-1][1] = value
        else:
            masks.append([value, value])
    return [(numbers >= low) & (numbers <= high) for low, high in masks]


def main(table, talus, requests):
    rows = [row for row in csv.DictReader(open(table)) if float(row["sinkage_m"]) < float(row["wheel_radius_m"])]
    x = np.array([[float(row[f]) for f in FEATURES] for row in rows])
    measured = {"drawbar_pull_over_load": np.array([float(r["drawbar_pull_N"]) / float(r["load_N"]) for r in rows]),
                "side_force_over_load": np.array([float(r["side_force_N"]) / float(r["load_N"]) for r in rows]),
                "sinkage_over_radius": np.array([float(r["sinkage_m"]) / float(r["wheel_radius_m"]) for r in rows])}
    print("| held out | rows | channel | base | refined | Gaussian process |\n|---|---|---|---|---|---|")
    for request in requests:
        ran = subprocess.run([talus, "trace", table, "--hold-out", request, "--json", "--quiet"], capture_output=True, text=True)
        told = json.loads(ran.stdout)["hold_out"]
        masks = parts(rows, request)
        if [part["rows"] for part in told] != [int(mask.sum()) for mask in masks]:
            sys.exit(f"{request}: other rows than those of the program: {[part['rows'] for part in told]}, {[int(m.sum()) for m in masks]}")
        for channel in CHANNELS:
            errors = np.concatenate([measured[channel][m] - predict(x[~m], measured[channel][~m], x[m]) for m in masks])
            total = sum(part["rows"] for part in told)

            def pooled(key):
                return np.sqrt(sum(part["rows"] * part[key][channel] ** 2 for part in told) / total)

            print(f"| {request} | {total} | {channel} | {pooled('base_rmse'):.3f} | {pooled('refined_rmse'):.3f} | "
                  f"{np.sqrt(np.mean(errors ** 2)):.3f} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
