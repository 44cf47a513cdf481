#!/usr/bin/python3
"""Shows   a map with two soils, a patch and telemetry, routes before and after, and pictures of each.
Needs   the packages talus and matplotlib.
Prints  one line per step; writes PNGs to the given folder, default the current one.
Next    rover_map.py: a map that grows as the rover drives."""

import math
import pathlib
import sys

import matplotlib  # type: ignore[import]

matplotlib.use("Agg")

import matplotlib.axes  # type: ignore[import]
import matplotlib.pyplot as plt  # type: ignore[import]
import numpy as np
import numpy.typing as npt
from matplotlib.colors import BoundaryNorm, ListedColormap  # type: ignore[import]

import talus

Floats = npt.NDArray[np.float32]
WIDTH, HEIGHT, CELL_M = 160, 100, 0.5
START, GOAL = (8.0, 25.0), (72.0, 25.0)


def hills() -> Floats:
    """Return rolling ground, up to some 2 m high."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] * CELL_M + 0.5 * CELL_M
    heights = 0.8 * np.sin(x / 11.0) * np.cos(y / 9.0) + 1.2 * np.exp(-((x - 25.0) ** 2 + (y - 20.0) ** 2) / 60.0)
    return np.asarray(heights, np.float32)


def soils() -> npt.NDArray[np.uint8]:
    """Return class 1 everywhere except a band of class 2 across the route, with ways round both ends."""
    classes = np.ones((HEIGHT, WIDTH), np.uint8)
    classes[4:96, 84:112] = 2
    return classes


def crater(ground: talus.Map, x_m: float, y_m: float) -> None:
    """Patch the heights with a crater with a steep wall, as observed from close range."""
    reach = 16
    column, row = round(x_m / CELL_M) - reach, round(y_m / CELL_M) - reach
    y, x = np.mgrid[row : row + 2 * reach, column : column + 2 * reach] * CELL_M + 0.5 * CELL_M
    radius = np.hypot(x - x_m, y - y_m)
    seen = ground.heights[row : row + 2 * reach, column : column + 2 * reach].copy()
    depth = np.where(radius < 6.0, -2.5 * np.cos(radius / 6.0 * math.pi / 2), 0.0)
    ground.patch(np.asarray(seen + depth, np.float32), south_west=(column * CELL_M, row * CELL_M))


def weak_drive(ground: talus.Map) -> int:
    """Add telemetry of four wheels in the band of class 2, with far more slip and sinkage than its soil predicts."""
    ahead, left = np.array([0.45, 0.45, -0.45, -0.45]), np.array([0.4, -0.4, 0.4, -0.4])
    x = np.repeat(np.arange(42.5, 46.0, 0.5), 4)
    moments = np.arange(x.size // 4)
    return ground.learn(
        {
            "wheel": np.tile(np.arange(4), moments.size),
            "time_s": np.repeat(60.0 * moments, 4),
            "x_m": x + np.tile(ahead, moments.size),
            "y_m": 25.0 + np.tile(left, moments.size),
            "heading_rad": np.zeros(x.size),
            "slope_rad": np.zeros(x.size),
            "load_N": np.full(x.size, 36.5),
            "slip": np.full(x.size, 0.6),
            "sinkage_m": np.full(x.size, 0.08),
        }
    )


def extent(ground: talus.Map) -> tuple[float, float, float, float]:
    rows, columns = ground.shape
    return (0.0, columns * ground.resolution_m, 0.0, rows * ground.resolution_m)


def draw_route(axes: matplotlib.axes.Axes, route: talus.Route, colour: str, label: str) -> None:
    axes.plot(route["x_m"], route["y_m"], color=colour, linewidth=2, label=label)


def ends(axes: matplotlib.axes.Axes, title: str) -> None:
    axes.plot(*START, "o", color="black", markersize=7)
    axes.plot(*GOAL, "*", color="black", markersize=12)
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]", aspect="equal")


def picture_of_categories(ground: talus.Map, routes: dict[str, talus.Route], path: pathlib.Path) -> None:
    figure, axes = plt.subplots(figsize=(9, 5.4))
    colours = ListedColormap(["#7fbf7b", "#fdd870", "#d7604d", "#bdbdbd"])
    shown = axes.imshow(
        ground.beliefs()["category"], origin="lower", extent=extent(ground), cmap=colours, norm=BoundaryNorm([0, 1, 2, 3, 4], 4)
    )
    bar = figure.colorbar(shown, ax=axes, ticks=[0.5, 1.5, 2.5, 3.5], shrink=0.8)
    bar.ax.set_yticklabels(["safe", "marginal", "dangerous", "unknown"])
    contours = axes.contour(ground.heights, levels=12, extent=extent(ground), colors="black", linewidths=0.4, alpha=0.5)
    axes.clabel(contours, fontsize=7, fmt="%.1f m")
    for (label, route), colour in zip(routes.items(), ("#2166ac", "#762a83", "#1b1b1b")):
        draw_route(axes, route, colour, label)
    ends(axes, "Traversability and routes")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, -0.34), ncol=len(routes), frameon=False)
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)


def picture_of_strength(before: Floats, ground: talus.Map, path: pathlib.Path) -> None:
    after = ground.beliefs()
    figure, (left, right) = plt.subplots(2, 1, figsize=(9, 9), layout="constrained")
    low, high = float(np.nanmin(after["pull_mean"])), float(np.nanmax(before))
    for axes, values, title in (
        (left, before, "Estimated drawbar pull over load, from the soils' priors"),
        (right, after["pull_mean"], "The same with telemetry of one drive"),
    ):
        shown = axes.imshow(values, origin="lower", extent=extent(ground), cmap="viridis", vmin=low, vmax=high)
        ends(axes, title)
        figure.colorbar(shown, ax=axes, label="DP/W [-]", shrink=0.8)
    # White: cells with telemetry.
    rows, columns = np.nonzero(after["evidence"])
    right.plot((columns + 0.5) * CELL_M, (rows + 0.5) * CELL_M, ".", color="white", markersize=1)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def picture_of_profile(route: talus.Route, path: pathlib.Path) -> None:
    along_m = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(route["x_m"]), np.diff(route["y_m"])))))
    figure, axes = plt.subplots(4, 1, figsize=(9, 8), sharex=True, layout="constrained")
    for one, column, unit, scale in (
        (axes[0], "elevation_m", "elevation [m]", 1.0),
        (axes[1], "slip", "slip [-]", 1.0),
        (axes[2], "sinkage_m", "sinkage [mm]", 1000.0),
        (axes[3], "energy_J", "energy [kJ]", 0.001),
    ):
        one.plot(along_m, route[column] * scale, color="#2166ac", drawstyle="steps-post" if column in ("slip", "sinkage_m") else "default")
        one.set_ylabel(unit)
        one.grid(alpha=0.3)
    axes[0].set_title("Along the route after the drive")
    axes[-1].set_xlabel("distance [m]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def planned(ground: talus.Map, what: str) -> talus.Route:
    route = ground.plan(START, GOAL)
    if not route.found:
        raise SystemExit(f"{what}: {route.reason}")
    print(f"{what}: {route.length_m:.1f} m, {route.energy_J:.0f} J, immobilisation probability {route.immobilisation_risk:.2g}")
    return route


def main() -> None:
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    folder.mkdir(parents=True, exist_ok=True)
    ground = talus.Map(
        hills(), resolution_m=CELL_M, rover="lunar_micro", soils={1: "lunar_nominal", 2: "soft_soil"}, classes=soils()
    )
    routes = {"as mapped": planned(ground, "as mapped")}
    crater(ground, 36.0, 25.0)
    routes["with the crater"] = planned(ground, "with the crater")
    prior = ground.beliefs()["pull_mean"].copy()
    print(f"{weak_drive(ground)} rows of telemetry taught something")
    routes["after the drive"] = planned(ground, "after the drive")
    picture_of_categories(ground, routes, folder / "categories.png")
    picture_of_strength(prior, ground, folder / "strength.png")
    picture_of_profile(routes["after the drive"], folder / "profile.png")
    print(f"pictures: {', '.join(str(p) for p in sorted(folder.glob('*.png')))}")


if __name__ == "__main__":
    main()
