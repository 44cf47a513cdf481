"""The Python package: what it plans, that nothing is copied, what it refuses, threads and Ctrl-C."""

import ast
import base64
import gc
import hashlib
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import threading
import unittest
import unittest.mock
import warnings
import xml.etree.ElementTree
import zlib

import numpy as np

import talus


def level(rows=60, columns=60, **more):
    how = dict(resolution_m=0.5, rover="lunar_micro", soils="lunar_nominal")
    how.update(more)
    return talus.Map(np.zeros((rows, columns), np.float32), **how)


def wheels(x_m, y_m, slip=0.5, sinkage_m=0.1, count=5):
    n = np.ones(count)
    return {
        "time_s": np.arange(count, dtype=float),
        "x_m": x_m * n,
        "y_m": y_m * n,
        "load_N": 36.5 * n,
        "slip": slip * n,
        "sinkage_m": sinkage_m * n,
        "slope_rad": 0.0 * n,
        "heading_rad": 0.0 * n,
    }


def run(*words, cwd=None):
    """Return what the program prints as JSON."""
    call = [os.environ["TALUS_PROGRAM"], *map(str, words), "--json", "--quiet"]
    return json.loads(subprocess.run(call, capture_output=True, cwd=cwd).stdout)


def write_table(path, columns):
    rows = [list(columns), *zip(*(np.asarray(values).tolist() for values in columns.values()))]
    path.write_text("".join(",".join(map(str, row)) + "\n" for row in rows))


def table_of(path):
    """Return the columns of a CSV: numbers where all fields are numbers or empty, else text."""
    rows = [line.split(",") for line in pathlib.Path(path).read_text().splitlines()]
    columns = {}
    for name, *fields in zip(*rows):
        try:
            columns[name] = np.array([float(f) if f else math.nan for f in fields])
        except ValueError:
            columns[name] = np.array(fields)
    return columns


class Refusals(unittest.TestCase):
    def refused(self, error, word, call):
        with self.assertRaises(error) as caught:
            call()
        self.assertIn(word, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))


class MapTest(Refusals):
    def test_a_route_over_level_ground_is_straight(self):
        route = level().plan((5.0, 10.0), (25.0, 10.0))
        self.assertEqual(route.status, "found")
        self.assertAlmostEqual(route.length_m, 20.0, places=6)  # Closed form
        self.assertLessEqual(route.lower_bound_J, route.cost_J)
        self.assertEqual(route["x_m"][0], 5.0)
        self.assertEqual(route["x_m"][-1], 25.0)
        self.assertEqual(len(route), route["energy_J"].size)
        self.assertTrue(np.all(np.diff(route["energy_J"]) > 0))

    def test_nothing_is_copied(self):
        ground = level(classes=np.ones((60, 60), np.uint8), soils={1: "lunar_nominal"}, layers={"own": np.full((60, 60), 5.0)})
        heights = ground.heights
        self.assertEqual(heights.__array_interface__["data"], ground.heights.__array_interface__["data"])
        ground.patch(np.full((4, 4), 0.25, np.float32), south_west=(5.0, 5.0))
        self.assertEqual(heights[10, 10], 0.25)  # the view shows the patch
        beliefs = ground.beliefs()
        first = beliefs["pull_mean"].__array_interface__["data"][0]
        self.assertEqual(beliefs["pull_std"].__array_interface__["data"][0] - first, 4)
        route = ground.plan((5.0, 20.0), (25.0, 20.0))
        self.assertEqual(route["y_m"].__array_interface__["data"][0] - route["x_m"].__array_interface__["data"][0], 8)
        for view in (heights, ground.classes, ground.layer("own"), beliefs["category"], route["x_m"]):
            self.assertFalse(view.flags.writeable)
            self.assertFalse(view.flags.owndata)
            with self.assertRaises(ValueError):
                view[...] = 0

    def test_views_outlive_what_they_came_from(self):
        ground = level()
        heights, x_m, mean = ground.heights, ground.plan((5.0, 10.0), (25.0, 10.0))["x_m"], ground.beliefs()["pull_mean"]
        kept = mean.copy()
        del ground
        gc.collect()
        level()  # allocates memory that may reuse freed arrays
        self.assertEqual(float(heights.sum()), 0.0)
        self.assertEqual(x_m[-1], 25.0)
        np.testing.assert_array_equal(mean, kept)

    def test_strides_and_doubles_are_read_as_they_are(self):
        rng = np.random.default_rng(3)
        heights = rng.uniform(0.0, 0.02, (40, 30))
        wide = np.zeros((80, 60))
        wide[::2, ::2] = heights
        how = dict(resolution_m=0.5, rover="lunar_micro", soils="lunar_nominal")
        plain = talus.Map(heights.astype(np.float32), **how)
        for same in (wide[::2, ::2], np.asfortranarray(heights), heights[::-1, ::-1].copy()[::-1, ::-1]):
            np.testing.assert_array_equal(talus.Map(same, **how).heights, plain.heights)
        read_only = heights.astype(np.float32)
        read_only.flags.writeable = False
        np.testing.assert_array_equal(talus.Map(read_only, **how).heights, plain.heights)

    def test_patched_ground_is_driven_around(self):
        ground = level()
        ground.patch(south_west=(14.0, 0.0), keep_out=np.ones((36, 4), bool))
        self.assertEqual(ground.version, 2)
        route = ground.plan((5.0, 10.0), (25.0, 10.0))
        self.assertGreater(route.length_m, 24.0)  # around the wall, which ends at y = 18
        self.assertEqual(ground.dangers(np.column_stack([route["x_m"], route["y_m"]])), [])
        straight = ground.dangers(np.array([[5.0, 10.0], [25.0, 10.0]]))
        self.assertTrue(any(14.0 <= x <= 16.0 for x, *_ in straight))

    def test_layers_cost_joules_a_metre(self):
        plain = level().plan((5.0, 10.0), (25.0, 10.0))
        dearer = level(layers={"own": np.full((60, 60), 20.0)}).plan((5.0, 10.0), (25.0, 10.0))
        self.assertAlmostEqual(dearer.cost_J - plain.cost_J, 400.0, delta=0.01)  # Closed form: 20 m
        refused = np.zeros((60, 60))
        refused[:, 28:32] = np.inf
        self.assertFalse(level(layers={"own": refused}).plan((5.0, 10.0), (25.0, 10.0)).found)

    def test_wheels_teach(self):
        ground = level()
        before = ground.beliefs()["pull_mean"][20, 20]
        self.assertGreater(ground.learn(wheels(10.25, 10.25)), 0)
        self.assertLess(ground.beliefs()["pull_mean"][20, 20], before)
        unmeasured = {**wheels(10.25, 10.25), "drawbar_pull_N": np.full(5, np.nan)}
        self.assertEqual(level().learn(unmeasured), level().learn(wheels(10.25, 10.25)))
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "drive.csv"
            write_table(table, wheels(20.25, 20.25))
            ground.learn(table)
        self.assertLess(ground.beliefs()["pull_mean"][40, 40], before)

    def test_files_and_settling_are_those_of_the_program(self):
        """Property: a drive learned in two parts and settled is the map of `talus update`, and the route that of `talus plan`."""
        hill = pathlib.Path(__file__).resolve().parents[3] / "examples" / "hill.asc"
        # Four wheels on alternating slopes; slip changes with slope, so the update can verify the sensors.
        moment, wheel = np.repeat(np.arange(80.0), 4), np.tile(np.arange(4.0), 80)
        slope = 0.15 * np.sin(moment / 7.0)
        slip = 0.05 + 0.2 * (slope + 0.15) + np.random.default_rng(3).normal(0.0, 0.006, moment.size)
        columns = {"time_s": moment, "wheel": wheel, "x_m": 5.0 + 0.35 * moment, "y_m": 15.5 + 0.0 * moment, "load_N": 36.5 + 0.0 * moment}
        columns.update(slip=slip, slope_rad=slope, heading_rad=0.0 * moment, sinkage_m=0.01 + 0.0 * moment, torque_Nm=3.65 * (0.2 + slope))
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            run("costmap", hill, "--ignore-crs", "--resolution", 1, "--rover", "lunar_micro", "--soil", "lunar_nominal", "-o", folder / "map.ot")
            write_table(folder / "drive.csv", columns)
            run("update", folder / "map.ot", folder / "drive.csv", "-o", folder / "driven.ot")
            parts = talus.Map.read(folder / "map.ot")
            untaught = parts.beliefs()["pull_mean"]
            for half in (slice(0, 160), slice(160, 320)):
                parts.learn({column: values[half] for column, values in columns.items()})
            unsettled = parts.beliefs()["pull_mean"]
            parts.settle()
            self.assertTrue(np.any(parts.beliefs()["pull_mean"] != unsettled))
            driven = talus.Map.read(folder / "driven.ot", threads=2)
            for column, values in driven.beliefs().items():
                np.testing.assert_array_equal(parts.beliefs()[column], values, err_msg=column)
            self.assertTrue(np.any(driven.beliefs()["pull_mean"] != untaught))
            driven.save(folder / "saved.ot")
            self.assertEqual((folder / "saved.ot").read_bytes(), (folder / "driven.ot").read_bytes())
            route = driven.plan((5.5, 15.5), (35.5, 15.5), prove=True)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # local metres in GeoJSON
                driven.write_route(route, folder / "ours.geojson")
            run("plan", hill, "--ignore-crs", "--resolution", 1, "--map", folder / "driven.ot", "--start", "5.5,15.5", "--goal", "35.5,15.5", "-o", folder / "its.geojson")
            ours, its = (json.loads((folder / f).read_text())["features"][0] for f in ("ours.geojson", "its.geojson"))
            self.assertEqual(ours["geometry"], its["geometry"])
            for key, values in its["properties"].items():
                if key != "inputs":
                    self.assertEqual(ours["properties"][key], values, key)
            stored = (folder / "driven.ot").read_bytes()
            files = {file["role"]: file for file in ours["properties"]["inputs"]["files"]}
            self.assertEqual(files["map"], {"file": "driven.ot", "path": str(folder / "driven.ot"), "role": "map", "size": len(stored), "sha256": hashlib.sha256(stored).hexdigest()})
            self.assertEqual(files["elevation"]["file"], pathlib.Path(hill).name)
            subprocess.run([os.environ["TALUS_PROGRAM"], "view", folder / "ours.geojson", "-o", folder / "ours.html", "--quiet"], check=True)

    def test_files_that_cannot_be_are_one_line(self):
        self.refused(talus.InputError, "missing.ot", lambda: talus.Map.read("missing.ot"))
        self.refused(ValueError, "threads = 0", lambda: talus.Map.read("missing.ot", threads=0))
        self.refused(talus.InputError, "/nowhere", lambda: level().save("/nowhere/map.ot"))
        ground = level()
        self.refused(ValueError, "must be found", lambda: ground.write_route(ground.plan((5.0, 10.0), (500.0, 10.0)), "r.geojson"))
        before = ground.beliefs()["pull_mean"]
        ground.settle()  # no rows were added before
        np.testing.assert_array_equal(ground.beliefs()["pull_mean"], before)

    def test_a_moved_map_keeps_what_it_knows(self):
        ground = level(rows=130, columns=200)
        ground.learn(wheels(50.25, 30.25))
        before = ground.beliefs()["evidence"]
        ground.move(1, 0)
        self.assertEqual(ground.south_west, (32.0, 0.0))
        np.testing.assert_array_equal(ground.beliefs()["evidence"][:, :136], before[:, 64:])
        self.assertTrue(np.isnan(ground.heights[:, 136:]).all())

    def test_a_point_cloud_becomes_a_patch(self):
        points = np.array([[5.1, 5.1, 0.1], [5.2, 5.2, 0.3], [5.6, 5.1, 0.2], [99.0, 5.0, 7.0], [5.6, 5.6, np.nan]])
        seen = talus.heights_from_points(points, (2, 2), resolution_m=0.5, south_west=(5.0, 5.0))
        np.testing.assert_array_equal(seen, np.array([[0.3, 0.2], [np.nan, np.nan]], np.float32))
        low = talus.heights_from_points(points, (2, 2), resolution_m=0.5, south_west=(5.0, 5.0), percentile=0.5, least_points=2)
        np.testing.assert_array_equal(low, np.array([[0.1, np.nan], [np.nan, np.nan]], np.float32))
        ground = level()
        ground.patch(seen, south_west=(5.0, 5.0))
        self.assertEqual(ground.heights[10, 10], np.float32(0.3))
        how = dict(resolution_m=0.5, south_west=(5.0, 5.0))
        for error, word, call in (
            (ValueError, "points: shape (5, 2), must be (n, 3)", lambda: talus.heights_from_points(points[:, :2], (2, 2), **how)),
            (TypeError, "points: dtype int64", lambda: talus.heights_from_points(np.zeros((3, 3), int), (2, 2), **how)),
            (ValueError, "no cell of the grid", lambda: talus.heights_from_points(points[:0], (2, 2), **how)),
            (ValueError, "shape must be", lambda: talus.heights_from_points(points, (0, 2), **how)),
            (ValueError, "percentile", lambda: talus.heights_from_points(points, (2, 2), percentile=2.0, **how)),
        ):
            self.refused(error, word, call)

    def test_what_cannot_be_is_one_line(self):
        good = np.zeros((8, 8), np.float32)
        how = dict(resolution_m=0.5, rover="lunar_micro", soils="lunar_nominal")
        infinite = good.copy()
        infinite[3, 2] = math.inf
        for error, word, heights in (
            (TypeError, "heights: list, must be a numpy array", [[0.0]]),
            (TypeError, "heights: NoneType", None),
            (TypeError, "dtype int64", np.zeros((8, 8), np.int64)),
            (TypeError, "dtype complex128", np.zeros((8, 8), complex)),
            (TypeError, "dtype object", np.full((8, 8), None)),
            (TypeError, "dtype >f4", good.astype(">f4")),
            (TypeError, "dtype float16", good.astype(np.float16)),
            (ValueError, "heights: shape (8,)", np.zeros(8, np.float32)),
            (ValueError, "heights: shape (8, 8, 1)", np.zeros((8, 8, 1), np.float32)),
            (ValueError, "heights: shape (0, 8)", np.zeros((0, 8), np.float32)),
            (ValueError, "heights[3, 2] is infinite", infinite),
            (ValueError, "heights[0, 0] is infinite", np.full((8, 8), 1e300)),
        ):
            self.refused(error, word, lambda: talus.Map(heights, **how))
        for error, word, more in (
            (ValueError, "resolution_m = 0.0", dict(resolution_m=0.0)),
            (ValueError, "resolution_m = nan", dict(resolution_m=math.nan)),
            (ValueError, "south_west must be finite", dict(south_west=(math.inf, 0.0))),
            (ValueError, "classes: shape (8, 7), must be (8, 8)", dict(classes=np.zeros((8, 7), np.uint8))),
            (TypeError, "classes: dtype float32, must be uint8 or bool", dict(classes=good)),
            (TypeError, "rocks: dtype uint8", dict(rocks=good.astype(np.uint8))),
            (ValueError, "soils has more than one class", dict(soils={1: "lunar_nominal", 2: "loam"})),
            (ValueError, "class 255, must be 0 to 254", dict(soils={255: "loam"})),
            (TypeError, "must be a name or a talus.Soil", dict(soils=3)),
            (talus.InputError, "lunar_nominal", dict(soils="lunar_nominl")),
            (talus.InputError, "fido", dict(rover="fidoo")),
            (TypeError, "rover must be", dict(rover=7)),
            (ValueError, "threads = 0", dict(threads=0)),
            (ValueError, "layer 'own'", dict(layers={"own": np.full((8, 8), -1.0)})),
            (ValueError, "layers['own']: shape", dict(layers={"own": np.zeros((2, 2))})),
            (ValueError, "'allow_marginl' is not known; did you mean allow_marginal?", dict(thresholds={"allow_marginl": True})),
            (TypeError, "allow_marginal must be True or False", dict(thresholds={"allow_marginal": 1})),
            (TypeError, "time_weight_W must be a number", dict(thresholds={"time_weight_W": "1"})),
            (ValueError, "slope_margin_rad = 3, must be in [0, 0.5]", dict(thresholds={"slope_margin_rad": 3})),
            (talus.InputError, "crs 'EPSG:1': is not known; give an EPSG code", dict(crs="EPSG:1")),
            (talus.InputError, "crs 'EPSG:4326': CRS 'WGS 84' is not projected", dict(crs="EPSG:4326")),
        ):
            self.refused(error, word, lambda: talus.Map(good, **{**how, **more}))

    def test_bad_patches_and_columns_change_nothing(self):
        ground = level()
        before, version = ground.heights.copy(), ground.version
        patch = np.zeros((4, 4), np.float32)
        for error, word, call in (
            (ValueError, "patch: give heights", lambda: ground.patch(south_west=(0.0, 0.0))),
            (ValueError, "off the map", lambda: ground.patch(patch, south_west=(1000.0, 0.0))),
            (ValueError, "", lambda: ground.patch(patch * np.nan, south_west=(0.0, 0.0))),
            (ValueError, "", lambda: ground.patch(patch + 1e30, south_west=(0.0, 0.0))),
            (ValueError, "", lambda: ground.patch(patch, south_west=(0.1, 0.0))),
            (ValueError, "rocks: shape", lambda: ground.patch(patch, rocks=patch[:2], south_west=(0.0, 0.0))),
            (TypeError, "column 'slip' must be", lambda: ground.learn({**wheels(5.0, 5.0), "slip": [0.1] * 5})),
            (TypeError, "column 'slip': dtype bool", lambda: ground.learn({**wheels(5.0, 5.0), "slip": np.ones(5, bool)})),
            (talus.InputError, "columns", lambda: ground.learn({**wheels(5.0, 5.0), "slip": np.array(["a"] * 5)})),
            (ValueError, "has 2 values, must be 5", lambda: ground.learn({**wheels(5.0, 5.0), "slip": np.zeros(2)})),
            (talus.InputError, "columns", lambda: ground.learn({**wheels(5.0, 5.0), "load_N": np.full(5, -1.0)})),
            (talus.InputError, "columns", lambda: ground.learn({"x_m": np.zeros(2)})),
            (talus.InputError, "missing.csv", lambda: ground.learn("missing.csv")),
            (KeyError, "no layer", lambda: ground.layer("own")),
            (ValueError, "shape (3,)", lambda: ground.dangers(np.zeros(3))),
            (ValueError, "is not finite", lambda: ground.dangers(np.full((2, 2), math.nan))),
            (ValueError, "leaves nothing", lambda: ground.move(5, 0)),
            (ValueError, "path: shape (3,)", lambda: ground.score(np.zeros(3))),
            (ValueError, "the path has no point", lambda: ground.score(np.zeros((0, 2)))),
            (talus.InputError, "the map spans x 0 to 30 m", lambda: ground.explain((99.0, 5.0))),
            (TypeError, "place must be (x_m, y_m)", lambda: ground.explain(5.0)),
            (talus.InputError, "place a,b: 'a' is not a number", lambda: ground.explain("a,b")),
            (talus.InputError, "no.tif", lambda: talus.Map.from_files("no.tif")),
        ):
            self.refused(error, word, call)
        self.assertEqual(ground.version, version)
        np.testing.assert_array_equal(ground.heights, before)

    def test_bad_requests_are_one_line(self):
        ground = level()
        for error, word, call in (
            (ValueError, "field", lambda: ground.plan((5.0, 5.0), (9.0, 9.0), planner="feild")),
            (ValueError, "threads", lambda: ground.plan((5.0, 5.0), (9.0, 9.0), threads=0)),
            (ValueError, "heading", lambda: ground.plan((5.0, 5.0), (9.0, 9.0), planner="field", start_heading_rad=0.0)),
            (TypeError, "progress must be callable", lambda: ground.plan((5.0, 5.0), (9.0, 9.0), progress=3)),
            (KeyError, "no column", lambda: ground.plan((5.0, 5.0), (9.0, 9.0))["slope"]),
        ):
            self.refused(error, word, call)
        self.assertEqual(ground.plan((5.0, 5.0), (900.0, 9.0)).status, "goal_invalid")
        self.assertTrue(ground.plan((5.0, 5.0), (9.0, 9.0)).found)


    def test_a_route_has_the_heights_of_its_ground(self):
        y, x = np.mgrid[0:40, 0:80]
        heights = np.asarray(0.02 * x + 0.01 * y, np.float32)
        ground = talus.Map(heights, resolution_m=0.5, rover="lunar_micro", soils="lunar_nominal")
        route = ground.plan((5.0, 10.0), (35.0, 12.0))
        self.assertTrue(route.found, route.reason)
        # Closed form: the plane through the middles of the cells.
        plane = 0.02 * (route["x_m"] / 0.5 - 0.5) + 0.01 * (route["y_m"] / 0.5 - 0.5)
        np.testing.assert_allclose(route["elevation_m"], plane, atol=1e-6)


class SiteTest(Refusals):
    """What a generated site of the Moon gives here and in the program."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.at = pathlib.Path(folder.name)
        run("generate", "craters", "--size", 80, "--resolution", 1, "--seed", 7, "-o", "moon.tif", cwd=cls.at)
        names = dict(soils="moon_soils.yaml", terrain="moon_classes.tif", rocks="moon_rocks.tif")
        cls.words = ["--rover", "lunar_micro", *(w for name, file in names.items() for w in ("--" + name, cls.at / file))]
        cls.files = {{"terrain": "classes"}.get(name, name): str(cls.at / file) for name, file in names.items()}
        cls.ground = talus.Map.from_files(cls.at / "moon.tif", rover="lunar_micro", **cls.files)
        cls.route = cls.ground.plan((15.0, 15.0), (65.0, 60.0), prove=True)

    def said(self, subcommand, *more):
        return run(subcommand, self.at / "moon.tif", *self.words, *more)

    def test_files_make_the_map_of_the_program(self):
        self.assertEqual({k: getattr(self.ground, k) for k in ("crs", "body")}, {k: run("info", self.at / "moon.tif")[k] for k in ("crs", "body")})
        named = dict(zip(("safe", "marginal", "dangerous", "unknown"), np.bincount(self.ground.categories().ravel(), minlength=4)))
        self.assertEqual(self.said("costmap", "-o", self.at / "m.ot")["categories"], named)
        self.assertEqual(talus.Map.read(self.at / "m.ot").crs, self.ground.crs)
        plain = talus.Map(self.ground.heights, resolution_m=1.0, rover="lunar_micro", soils="lunar_nominal").plan((15.0, 15.0), (65.0, 60.0))
        words = ("--rover", "lunar_micro", "--soil", "lunar_nominal", "--start", "15,15", "--goal", "65,60", "--no-proof")
        self.assertEqual(plain.cost_J, run("plan", self.at / "moon.tif", *words, "-o", self.at / "plain.geojson")["cost"])
        line = json.loads((self.at / "plain.geojson").read_text())["features"][0]["properties"]
        for column in plain.COLUMNS:
            np.testing.assert_array_equal(plain[column], np.array(line[column], float), err_msg=column)
        self.refused(talus.InputError, "read it with Map.read()", lambda: talus.Map.from_files(self.at / "m.ot"))
        with self.assertWarnsRegex(UserWarning, "no --rover: using default rover lunar_micro"):
            talus.Map.from_files(self.at / "moon.tif", soil="lunar_nominal", window="0,0,40,40")

    def test_a_route_is_written_by_its_ending(self):
        there = ("--start", "15,15", "--goal", "65,60")
        said = self.said("plan", *there, "-o", self.at / "its.csv")
        self.assertEqual((self.route.cost_J, self.route.gap), (said["cost"], said["gap"]))
        self.ground.write_route(self.route, self.at / "ours.csv")
        self.assertEqual((self.at / "ours.csv").read_text(), (self.at / "its.csv").read_text())
        self.ground.write_route(self.route, self.at / "ours.gpkg")
        self.assertTrue((self.at / "ours.gpkg").read_bytes().startswith(b"SQLite format 3"))
        self.assertAlmostEqual(self.said("score", "--path", self.at / "ours.gpkg")["cost"], self.route.cost_J, delta=1e-6)  # sums in another order
        with self.assertWarnsRegex(UserWarning, "longitudes and latitudes are of Moon"):
            self.ground.write_route(self.route, self.at / "ours.geojson")
        inputs = json.loads((self.at / "ours.geojson").read_text())["features"][0]["properties"]["inputs"]
        self.assertEqual(inputs["rover"], "lunar_micro")
        self.assertEqual([file["file"] for file in inputs["files"]][:2], ["moon.tif", "moon_classes.tif"])
        self.refused(talus.InputError, "places of Earth", lambda: self.ground.write_route(self.route, self.at / "r.kml"))

    def test_thresholds_are_those_of_the_program(self):
        words = ("--start", "15,15", "--goal", "65,60", "--no-proof", "--time-weight", "7", "--no-marginal", "--slope-uncertainty-deg", "2")
        chosen = dict(time_weight_W=7.0, allow_marginal=False, slope_margin_rad=math.radians(2))
        ground = talus.Map.from_files(self.at / "moon.tif", rover="lunar_micro", thresholds=chosen, **self.files)
        cost_J = ground.plan((15.0, 15.0), (65.0, 60.0)).cost_J
        self.assertEqual(cost_J, self.said("plan", *words)["cost"])
        self.assertGreater(cost_J, self.route.cost_J)
        self.assertEqual({name: ground.thresholds[name] for name in chosen}, chosen)

    def test_explain_and_score_are_those_of_the_program(self):
        for more, words in (({}, ()), (dict(heading_rad=1.5), ("--heading", "1.5"))):
            said = self.said("explain", "--at", "50,50", *words)
            why = self.ground.explain((50.0, 50.0), **more)
            for cause in why["causes"]:  # JSON has neither NaN nor inf
                cause.update({k: None for k in ("value", "std") if not math.isfinite(cause[k])})
            self.assertEqual(why, said)
        self.assertEqual(repr(self.ground.explain("50,50")), repr(self.ground.explain((50.0, 50.0))))
        path = np.array([[15.0, 15.0], [65.0, 60.0]])
        (self.at / "path.csv").write_text("x_m,y_m\n15,15\n65,60\n")
        score, said = self.ground.score(path, prove=True), self.said("score", "--path", self.at / "path.csv", "--prove")
        self.assertEqual((score.status, score.energy_J, score.best.cost_J), (said["status"], said["energy_J"], said["best_cost"]))
        self.assertEqual(score.violations, [(v["x_m"], v["y_m"], v["reason"]) for v in said["violations"]])
        own = self.ground.score(np.column_stack([self.route["x_m"], self.route["y_m"]]))
        self.assertEqual((own.status, own.violations, own.best), ("found", [], None))
        self.assertAlmostEqual(own.cost_J, self.route.cost_J, delta=1e-9 * own.cost_J)

    def test_notebooks_show_maps_and_routes(self):
        page = self.ground._repr_html_()
        png = base64.b64decode(re.search("base64,([^']+)'", page)[1])
        pixels = np.frombuffer(zlib.decompress(png[png.index(b"IDAT") + 4 : -16]), np.uint8).reshape(80, 81)
        np.testing.assert_array_equal(pixels[::-1, 1:], self.ground.categories())  # the first byte of a line is its filter
        track = self.route._repr_html_()
        self.assertIn(f"<td>{self.route.length_m:.5g}</td>", track)
        line = xml.etree.ElementTree.fromstring(re.search("<svg.*</svg>", track)[0])[0].get("points").split()
        drawn = np.array([point.split(",") for point in line], float)
        x, y = (self.route[k][:: len(self.route) - 1] for k in ("x_m", "y_m"))
        scale = 290 / max(np.ptp(self.route["x_m"]), np.ptp(self.route["y_m"]))  # Closed form: the track fills 290 units, north up
        np.testing.assert_allclose(drawn[-1] - drawn[0], scale * np.array([np.diff(x)[0], -np.diff(y)[0]]), atol=0.11)
        self.assertEqual((drawn.min(), drawn[:, 0].max() - drawn[:, 0].min()), (5.0, 290.0))
        self.assertIn("goal_invalid", level().plan((5.0, 5.0), (900.0, 9.0))._repr_html_())
        for html in (page, track):
            self.assertNotIn("http", html)
            self.assertLess(len(html), 20000)

    def test_arrays_have_a_coordinate_system(self):
        ground = level(crs="EPSG:32633", south_west=(500000.0, 5000000.0))
        self.assertEqual((ground.crs, ground.body, level().crs, level().body), ("WGS 84 / UTM zone 33N", "Earth", "local", None))
        route = ground.plan((500005.0, 5000010.0), (500025.0, 5000010.0))
        ground.write_route(route, self.at / "earth.geojson")
        places = json.loads((self.at / "earth.geojson").read_text())["features"][0]["geometry"]["coordinates"]
        # Closed form: one metre east of the central meridian, 15 degrees, is 1/(0.9996 N cos(latitude)) rad.
        latitude = math.radians(places[0][1])
        normal_m = 6378137.0 / math.sqrt(1.0 - 0.00669437999014 * math.sin(latitude) ** 2)
        self.assertAlmostEqual(places[0][0], 15.0 + math.degrees(5.0 / (0.9996 * normal_m * math.cos(latitude))), places=10)
        again = ground.plan(f"{places[0][1]!r}d,{places[0][0]!r}d", f"{places[-1][1]!r}d,{places[-1][0]!r}d")
        self.assertAlmostEqual(again.length_m, 20.0, places=4)


class BackgroundTest(unittest.TestCase):
    """A sampling planner without an end but its time limit of a day."""

    def endless(self, ground, **more):
        return ground.plan((5.0, 5.0), (190.0, 190.0), planner="RRTstar", time_limit_s=86400.0, **more)

    def big(self):
        rng = np.random.default_rng(1)
        return talus.Map(rng.uniform(0.0, 0.01, (400, 400)), resolution_m=0.5, rover="lunar_micro", soils="lunar_nominal")

    def test_ctrl_c_ends_a_plan(self):
        ground = self.big()
        handled = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            seen = []

            def progress(share):
                seen.append(share)
                os.kill(os.getpid(), signal.SIGINT)

            with self.assertRaises(KeyboardInterrupt):
                self.endless(ground, progress=progress)
        finally:
            signal.signal(signal.SIGINT, handled)
        self.assertTrue(ground.plan((5.0, 5.0), (9.0, 9.0)).found)  # the map is still usable

    def test_what_progress_raises_ends_a_plan(self):
        def progress(share):
            self.assertTrue(0.0 <= share <= 1.0)
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            self.endless(self.big(), progress=progress)

    def test_other_threads_run_while_one_plans(self):
        ground, other = self.big(), level()
        began, stop, failures, lengths = threading.Event(), threading.Event(), [], []

        def plan():
            def progress(share):
                began.set()
                if stop.is_set():
                    raise InterruptedError

            try:
                self.endless(ground, progress=progress)
            except InterruptedError:
                pass
            except Exception as error:  # checked by the main thread
                failures.append(error)

        planning = threading.Thread(target=plan)
        planning.start()
        began.wait()
        with self.assertRaisesRegex(RuntimeError, "another thread works on this map"):
            ground.patch(np.zeros((4, 4), np.float32), south_west=(0.0, 0.0))
        lengths.append(other.plan((5.0, 10.0), (25.0, 10.0)).length_m)
        stop.set()
        planning.join()
        self.assertEqual(failures, [])
        self.assertAlmostEqual(lengths[0], 20.0, places=6)


class TypesTest(unittest.TestCase):
    """The stubs name what there is: classes, members, and parameters in their order."""

    def parameters(self, function):
        named = [a.arg for a in function.args.args + function.args.kwonlyargs]
        return [name for name in named if name != "self"]

    def documented(self, function):
        signature = function.__doc__.splitlines()[0].split(" -> ")[0]
        return [name for name in re.findall(r"(?:\(|, )(\w+): ", signature) if name != "self"]

    def same_text(self, node, real):
        """The stub has the text that help() prints."""
        first, _, rest = (real.__doc__ or "").partition("\n")
        text = " ".join((rest if " -> " in first else first + " " + rest).split())
        self.assertEqual(" ".join((ast.get_docstring(node) or "").split()), text, node.name)
        self.assertTrue(text or node.name == "__init__", node.name)

    def test_stubs_name_what_there_is(self):
        module = talus._talus
        stub = ast.parse((pathlib.Path(talus.__file__).parent / "_talus.pyi").read_text())
        classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef) and node.name[0] != "_"}
        functions = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
        self.assertEqual({*classes, *functions}, {name for name in dir(module) if not name.startswith("_")})
        said = subprocess.run([os.environ["TALUS_PROGRAM"], "--version"], capture_output=True, text=True).stdout
        self.assertIn(module.__version__, said.split())
        for name, node in functions.items():
            self.assertEqual(self.parameters(node), self.documented(getattr(module, name)), name)
            self.same_text(node, getattr(module, name))
        for name, node in classes.items():
            if name == "InputError":
                continue
            members = {m.name for m in node.body if isinstance(m, ast.FunctionDef)}
            members |= {m.target.id for m in node.body if isinstance(m, ast.AnnAssign)}
            there = {m for m in vars(getattr(module, name)) if not m.startswith("_")}
            self.same_text(node, getattr(module, name))
            self.assertEqual({m for m in members if not m.startswith("_")}, there, name)
            for method in node.body:
                if isinstance(method, ast.FunctionDef) and not method.decorator_list and method.name != "__len__":
                    real = getattr(getattr(module, name), method.name)
                    if method.name != "_repr_html_":
                        self.assertEqual(self.parameters(method), self.documented(real), f"{name}.{method.name}")
                        self.same_text(method, real)


class SoilTest(Refusals):
    def test_the_library(self):
        self.assertIn("mer", talus.rovers())
        self.assertIn("dry_sand", talus.soils())
        rover = talus.Rover("mer")
        rover.mass_kg = 200.0
        self.assertEqual(rover.mass_kg, 200.0)
        rover.mass_kg = -1.0
        heights = np.zeros((8, 8), np.float32)
        self.refused(ValueError, "mass_kg", lambda: talus.Map(heights, resolution_m=0.5, rover=rover, soils="loam"))

    def test_an_estimate_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "runs.csv"
            columns = dict(wheel_radius_m=np.full(6, 0.13), wheel_width_m=np.full(6, 0.16), load_N=np.repeat([30.0, 60.0, 90.0], 2))
            columns.update(slip=np.array([0.1, 0.3, 0.2, 0.5, 0.4, 0.7]), torque_Nm=np.array([1.0, 1.8, 2.7, 4.2, 5.6, 6.8]))
            columns.update(sinkage_m=np.array([10, 13, 18, 24, 29, 35]) / 1000, drawbar_pull_N=np.array([4.0, 8.0, 10.0, 15.0, 18.0, 22.0]))
            write_table(table, columns)
            found = talus.estimate(table, method="sojourner")
            said = run("estimate", table, "--method", "sojourner")
            same = talus.estimate(columns, method="sojourner")
        self.assertEqual((same.cohesion_Pa, same.friction_angle_rad), (found.cohesion_Pa, found.friction_angle_rad))
        for name in ("cohesion_Pa", "friction_angle_rad", "rows_used"):
            self.assertAlmostEqual(getattr(found, name), said[name], places=9)
        self.assertEqual(found.covariance.shape, (2, 2))

    def test_forces_on_a_wheel_are_those_of_the_program(self):
        call = ("--soil", "sand", "--rover", "mer", "--slip", "0.3")
        for words, more in (((), {}), (("--load", "90", "--slip-angle", "0.2"), dict(load_N=90.0, slip_angle_rad=0.2))):
            forces, said = talus.wheel("sand", "mer", slip=0.3, **more), run("wheel", *call, *words)
            self.assertEqual(forces, {name: said[name] for name in forces})
        self.assertEqual(talus.wheel(talus.Soil("sand"), talus.Rover("mer"), slip=0.3), talus.wheel("sand", "mer", slip=0.3))
        for error, word, soil, rover, more in (
            (ValueError, "slip = 2.0", "sand", "mer", dict(slip=2.0)),
            (ValueError, "load_N = -1, must be > 0", "sand", "mer", dict(slip=0.1, load_N=-1.0)),
            (talus.InputError, "did you mean sand?", "snad", "mer", dict(slip=0.1)),
            (TypeError, "rover must be a name", "sand", 3, dict(slip=0.1)),
        ):
            self.refused(error, word, lambda: talus.wheel(soil, rover, **more))

    def test_what_cannot_be_estimated_is_one_line(self):
        columns = {"load_N": np.ones(3), "slip": np.ones(3)}
        self.refused(talus.InputError, "columns:1: no column torque_Nm", lambda: talus.estimate(columns, method="sojourner"))
        self.refused(talus.InputError, "missing.csv", lambda: talus.estimate("missing.csv", method="sojourner"))
        self.refused(talus.InputError, "method", lambda: talus.estimate("missing.csv", method="guess"))

    def test_a_trace_is_that_of_the_program(self):
        """Four wheels by the forward model, two percent off; wheel 2 pulls 6 N less than it should.

        Three rows have a side force and no slip angle, one is sunk to the axle, one has no load."""
        rover = talus.Rover("fido")
        rover.wheel_radius_m, rover.wheel_width_m, rover.grouser_height_m, rover.grouser_count = 0.1, 0.1, 0.0, 0
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            table = ["bin,run,wheel,load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,wheel_width_m,side_force_N"]
            for i in range(120):
                load_N, slip = 60.0 + 8.0 * (i % 6), 0.1 + 0.05 * (i % 11)
                forces = talus.wheel("sandy_loam", rover, slip=slip, load_N=load_N)
                off = [1.0 + 0.02 * math.sin(12.9 * i * i + phase) for phase in (1, 2, 3)]
                pull_N = forces["drawbar_pull_N"] + load_N * (off[2] - 1.0) - (6.0 if i % 4 == 2 else 0.0)
                table.append(
                    f"{'east' if i < 60 else 'west'},{i // 12},{i % 4},{load_N},{slip},{forces['torque_Nm'] * off[0]},"
                    f"{forces['sinkage_m'] * off[1]},{pull_N},0.1,0.1,"
                )
            for load_N, sinkage_m, force_N in ((80, 0.02, 15), (90, 0.02, 20), (70, 0.02, -9), (80, 0.11, ""), (-1, 0.02, "")):
                table.append(f"east,20,1,{load_N},0.3,2,{sinkage_m},9,0.1,0.1,{force_N}")
            path, base = folder / "runs.csv", folder / "base.yaml"
            path.write_text("\n".join(table) + "\n")
            base.write_text("{soil: sandy_loam, model: wong-reece}\n")
            shares = []
            found = talus.trace(path, base=str(base), progress=shares.append)
            said = run("trace", path, "--base", base, "--model-out", folder / "written.yaml")
            self.assertEqual(found.model_text(), (folder / "written.yaml").read_text())
            arrays = talus.trace(table_of(path), base=str(base))
            self.assertEqual(arrays.model_text(), found.model_text().replace(str(path), "columns"))
            (folder / "refined.yaml").write_text(found.model_text())
            self.assertEqual(run("predict", path, "--model", folder / "refined.yaml", "-o", folder / "predicted.csv")["rows_refused"], 1)
        self.assertEqual(found.verdict, said["verdict"])
        self.assertEqual((found.rows_used, found.rows_rejected, found.beyond_axle), (120, 4, 1))
        self.assertEqual(
            (found.rows_used, found.rows_rejected, found.beyond_axle),
            (said["rows_used"], said["rows_rejected"], said["beyond_axle"]["rows"]),
        )
        self.assertEqual((found.applies, found.applies_reason), (said["applies"], said["applies_reason"]))
        self.assertEqual(len(found.effects), len(said["effects"]))
        self.assertEqual(found.effects[0].covariate, "wheel")
        for mine, other in zip(found.effects, said["effects"]):
            self.assertEqual((mine.name, mine.channel, mine.p_value), (other["name"], other["channel"], other["p_value"]))
        for mine, other in (
            (found.base_rmse, said["base"]["rmse"]),
            (found.refined_rmse, said["refined"]["rmse"]),
            (found.held_out_refined_rmse, said["held_out"]["refined_rmse"]),
            (found.noise_floor, said["held_out"]["noise_floor"]),
        ):
            self.assertEqual(mine, other)
        self.assertTrue(all(0.0 <= share <= 1.0 for share in shares))

    def test_ctrl_c_ends_a_trace(self):
        rng, n = np.random.default_rng(1), np.ones(2000)
        slip, load_N = rng.uniform(0.1, 0.8, 2000), rng.uniform(30.0, 90.0, 2000)
        columns = dict(wheel_radius_m=0.13 * n, wheel_width_m=0.16 * n, load_N=load_N, slip=slip, sinkage_m=0.01 + 0.03 * slip)
        columns.update(torque_Nm=load_N * 0.13 * (0.3 + 0.3 * slip), drawbar_pull_N=load_N * (0.1 + 0.2 * slip))

        with self.assertRaises(KeyboardInterrupt):
            talus.trace(columns, progress=unittest.mock.Mock(side_effect=KeyboardInterrupt))

    def test_what_cannot_be_traced_is_one_line(self):
        self.refused(talus.InputError, "missing.csv", lambda: talus.trace("missing.csv"))
        self.refused(talus.InputError, "base.yaml", lambda: talus.trace("missing.csv", base="base.yaml"))
        self.refused(ValueError, "significance = 2", lambda: talus.trace("missing.csv", significance=2.0))
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "runs.csv"
            path.write_text("wheel_radius_m,wheel_width_m,load_N,slip,drawbar_pull_N\n0.1,0.1,30,0.2,3\n")
            self.refused(talus.InputError, "at least 5", lambda: talus.trace(path))

    def test_a_simulated_drive(self):
        ground = level(rows=30, columns=60)
        drive = talus.simulate(ground, (4.0, 7.0), (24.0, 7.0), belief="prior")
        self.assertEqual(drive.outcome, "reached")
        self.assertAlmostEqual(drive.x_m[-1], 24.0, delta=1.0)
        self.assertFalse(drive.x_m.flags.owndata)
        self.assertEqual(drive.x_m.size, drive.slip.size)
        again = talus.simulate(ground, (4.0, 7.0), (24.0, 7.0), belief="prior")
        np.testing.assert_array_equal(drive.slip, again.slip)
        self.refused(ValueError, "belief 'hope'", lambda: talus.simulate(ground, (4.0, 7.0), (24.0, 7.0), belief="hope"))


if __name__ == "__main__":
    unittest.main()
