#!/usr/bin/python3
"""Routes of GRASS r.walk and scikit-image against Talus', all priced by `talus score`.

Needs   apt-get install grass-core python3-skimage python3-gdal  (what is missing is left out, and said)
Run     tests/benchmark/compare_gis.py build/release/cli/talus DEM START GOAL [options of talus for map, rover, soil]
Prints  cost under Talus' cost function, how far above Talus' with its proof, cells that may not be driven, seconds of CPU,
        and the seconds of Talus over those of each other

r.walk gets the elevation, skimage.graph.MCP_Geometric the mean of the energy per metre up and down the steepest
slope; both see only cells that Talus lets the rover climb and descend straight on. START and GOAL are x,y.
"""

import csv
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile

UPHILL, DOWNHILL = "energy_per_metre_uphill", "energy_per_metre_downhill"  # bands of `talus costmap --geotiff`


def cpu_s():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN), resource.getrusage(resource.RUSAGE_SELF)
    return sum(u.ru_utime + u.ru_stime for u in usage)


def run(words, **more):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more).stdout


class Map:
    """The layers that Talus wrote, and cells by place."""

    def __init__(self, path):
        from osgeo import gdal
        gdal.UseExceptions()
        self.file = gdal.Open(path)
        self.west, self.cell, _, self.north, _, _ = self.file.GetGeoTransform()

    def band(self, name):
        for number in range(1, self.file.RasterCount + 1):
            band = self.file.GetRasterBand(number)
            if band.GetDescription() == name:
                return band.ReadAsArray().astype(float)
        raise ValueError(f"no band {name}")

    def index(self, place):
        return int((self.north - place[1]) / self.cell), int((place[0] - self.west) / self.cell)

    def centre(self, row, column):
        return self.west + (column + 0.5) * self.cell, self.north - (row + 0.5) * self.cell


def by_skimage(layers, start, goal):
    import numpy
    from skimage.graph import MCP_Geometric
    metre = 0.5 * (layers.band(UPHILL) + layers.band(DOWNHILL))
    search = MCP_Geometric(numpy.where(numpy.isfinite(metre), metre, -1.0))
    search.find_costs([layers.index(start)], [layers.index(goal)])
    return [layers.centre(*cell) for cell in search.traceback(layers.index(goal))]


GRASS = r"""
set -e
r.in.gdal -o --quiet input=layers.tif output=layers
g.region raster=layers.1
r.mapcalc --quiet "ground = if(isnull(layers.11) || isnull(layers.12), null(), layers.1)"
r.mapcalc --quiet "friction = 0.0"
r.walk -k --quiet elevation=ground friction=friction output=cost outdir=way start_coordinates=$1
r.path --quiet input=way vector_path=path start_coordinates=$2
v.out.ascii --quiet input=path format=standard output=path.txt
"""


def by_grass(folder, start, goal):
    with open(os.path.join(folder, "walk.sh"), "w", encoding="utf-8") as script:
        script.write(GRASS)
    place = "{},{}".format
    # Talus' layers may lie on a body that GRASS knows no projection of: a plain grid of metres does.
    run(["grass", "--tmp-location", "XY", "--exec", "bash", "walk.sh", place(*start), place(*goal)], cwd=folder)
    points = []
    with open(os.path.join(folder, "path.txt"), encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if len(words) == 2 and all(w.lstrip("-").replace(".", "", 1).isdigit() for w in words):
                points.append((float(words[0]), float(words[1])))
    return points[1:] if len(points) % 2 and points[:1] == points[1:2] else points


def scored(talus, dem, options, path):
    answer = subprocess.run([talus, "score", dem, "--path", path, "--json", "--quiet", *options],
                            stdout=subprocess.PIPE, text=True, check=False).stdout
    return json.loads(answer)


def attempt(name, plan, start, goal, folder):
    """The planner's route as a CSV and its seconds of CPU, or why there is none."""
    begin = cpu_s()
    try:
        points = plan()
    except ImportError as missing:
        return f"left out: {missing.name} is not installed", None
    except (subprocess.CalledProcessError, ValueError) as failed:
        return f"no route: {str(getattr(failed, 'stderr', '') or failed).strip().splitlines()[-1]}", None
    spent = cpu_s() - begin
    if points and abs(points[0][0] - goal[0]) + abs(points[0][1] - goal[1]) < \
            abs(points[0][0] - start[0]) + abs(points[0][1] - start[1]):
        points.reverse()
    path = os.path.join(folder, name + ".csv")
    with open(path, "w", newline="", encoding="utf-8") as out:
        rows = csv.writer(out)
        rows.writerow(["x_m", "y_m"])
        rows.writerows([start, *[p for p in points[1:-1]], goal])
    return path, spent


def main(talus, dem, start_text, goal_text, *options):
    talus, dem = os.path.abspath(talus), os.path.abspath(dem)
    start, goal = (tuple(float(v) for v in text.split(",")) for text in (start_text, goal_text))
    with tempfile.TemporaryDirectory() as folder:
        layers = os.path.join(folder, "layers.tif")
        run([talus, "costmap", dem, "-o", os.path.join(folder, "map.ot"), "--geotiff", layers, "--quiet", *options])
        print(f"{'planner':<18}{'cost J':>14}{'above %':>10}{'refused':>9}{'CPU s':>8}")
        own, own_s = None, {}
        for name, how in {"talus": [], "talus --no-proof": ["--no-proof"]}.items():
            begin = cpu_s()
            planned = json.loads(run([talus, "plan", dem, f"--start={start_text}", f"--goal={goal_text}", "--json",
                                      "--quiet", "--threads", "1", *how, *options]))
            own, own_s[name] = own or planned, cpu_s() - begin
            above = 100 * (planned["cost"] / own["cost"] - 1)
            print(f"{name:<18}{planned['cost']:>14.6g}{above:>10.2f}{0:>9}{own_s[name]:>8.2f}")
        peers = {"skimage MCP": lambda: by_skimage(Map(layers), start, goal)}
        if shutil.which("grass"):
            peers["r.walk -k"] = lambda: by_grass(folder, start, goal)
        else:
            print(f"{'r.walk -k':<18}left out: grass is not installed")
        ratios = {}
        for name, plan in peers.items():
            path, spent = attempt(name.split()[0], plan, start, goal, folder)
            if spent is None:
                print(f"{name:<18}{path}")
                continue
            answer = scored(talus, dem, options, path)
            cost, refused = answer.get("cost"), len(answer["violations"])
            if refused:
                print(f"{name:<18}{'-':>14}{'-':>10}{refused:>9}{spent:>8.2f}")
            else:
                print(f"{name:<18}{cost:>14.6g}{100 * (cost / own['cost'] - 1):>10.2f}{0:>9}{spent:>8.2f}")
            ratios[name] = [f"{seconds / spent:.3f}" for seconds in own_s.values()]
        for name, (proven, unproven) in ratios.items():
            print(f"CPU of talus over {name}: {proven}, without proof {unproven}")


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except subprocess.CalledProcessError as error:
        sys.exit(error.stderr.strip() or str(error))
