#!/usr/bin/python3
"""Shows   a map that grows with observations and wheel telemetry, and replanning, in Python.
Needs   the package talus.
Prints  one line per step: position, remaining length and energy.
Next    rover_loop.cpp: the same in C++."""

import math

import numpy as np
import numpy.typing as npt

import talus

WIDTH, HEIGHT, SEEN, CELL_M = 80, 60, 24, 0.5


def look(ground: talus.Map, x_m: float, y_m: float) -> None:
    """Observe 12 m x 12 m of level ground around the rover, with a wall of rock that has a gap in the north."""
    column = min(max(int(x_m / CELL_M) - SEEN // 2, 0), WIDTH - SEEN)
    row = min(max(int(y_m / CELL_M) - SEEN // 2, 0), HEIGHT - SEEN)
    rows, columns = np.mgrid[row : row + SEEN, column : column + SEEN]
    wall: npt.NDArray[np.bool_] = (columns >= 38) & (columns < 41) & (rows < 44)
    ground.patch(
        np.zeros((SEEN, SEEN), np.float32),
        rocks=wall.astype(np.float32),
        south_west=(column * CELL_M, row * CELL_M),
    )


def drive(ground: talus.Map, x_m: float, y_m: float, heading_rad: float, time_s: float) -> int:
    """Add telemetry of four wheels with low slip."""
    ahead, left = np.array([0.45, 0.45, -0.45, -0.45]), np.array([0.4, -0.4, 0.4, -0.4])
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    return ground.learn(
        {
            "wheel": np.arange(4),
            "time_s": np.full(4, time_s),
            "x_m": x_m + c * ahead - s * left,
            "y_m": y_m + s * ahead + c * left,
            "heading_rad": np.full(4, heading_rad),
            "load_N": np.full(4, 36.5),
            "slip": np.full(4, 0.04),
            "sinkage_m": np.full(4, 0.01),
            "slope_rad": np.zeros(4),
        }
    )


def main() -> None:
    rover = talus.Rover("lunar_micro")
    unseen = np.full((HEIGHT, WIDTH), np.nan, np.float32)
    ground = talus.Map(unseen, resolution_m=CELL_M, rover=rover, soils="lunar_nominal", allow_unknown=True)
    x_m, y_m = 5.0, 10.0
    goal = (35.0, 10.0)
    for step in range(60):
        look(ground, x_m, y_m)
        route = ground.plan((x_m, y_m), goal, tolerance_m=0.5)
        if not route.found:
            raise SystemExit(route.reason)
        print(f"step {step:2} at ({x_m:4.1f}, {y_m:4.1f}) m, {route.length_m:4.1f} m and {route.energy_J:5.0f} J to go")
        far = np.hypot(route["x_m"] - x_m, route["y_m"] - y_m) > 3.0
        next_vertex = int(np.argmax(far)) if bool(far.any()) else len(route) - 1
        x_m, y_m = float(route["x_m"][next_vertex]), float(route["y_m"][next_vertex])
        drive(ground, x_m, y_m, float(route["heading_rad"][next_vertex]), 60.0 * (step + 1))
        if next_vertex == len(route) - 1:
            break
    evidence = ground.beliefs()["evidence"]
    print(f"arrived at ({x_m:.1f}, {y_m:.1f}) m; telemetry in {np.count_nonzero(evidence)} cells")
    if math.hypot(x_m - goal[0], y_m - goal[1]) > 0.5:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
