"""What QGIS makes of the program's files: qgis_reads.py TALUS, in a folder of its own; 77 where there is no QGIS or no map.

Coordinate system, length and colours of a route and of categories at a lunar pole, in Gale crater and on a hillside.
"""
import os
import subprocess
import sys

try:
    from qgis.core import QgsApplication, QgsRasterLayer, QgsVectorLayer
except ImportError:
    sys.exit(77)

MAPS = os.environ.get("TALUS_REAL_MAPS", "")
SITES = [
    ("moon_lola_npc_2km_5m.tif", [], "126800,-93200", "128200,-91800", "+R=1737400 "),
    ("mars_ctx_gale_square_20m.tif", ["--rover", "mer", "--soil", "mars_blocky"], "8143500,-297000", "8144800,-294000",
     "+R=3396190 "),
    ("earth_rainier_srtm_80m_utm.tif", [], "640000,5120000", "642000,5123000", "+datum=WGS84 "),
]
COLOURS = {"safe": "#f2fff8", "marginal": "#e58e10", "dangerous": "#9e1020", "unknown": "#000000"}


def look(talus, name, ground, start, goal, body):
    dem = os.path.join(MAPS, name)
    subprocess.run([talus, "costmap", dem, *ground, "--categories", "c.tif", "--quiet", "--force"], check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run([talus, "plan", dem, *ground, "--start", start, "--goal", goal, "--no-proof", "-o", "r.gpkg",
                    "--quiet", "--force"], check=True, stdout=subprocess.DEVNULL)
    categories = QgsRasterLayer("c.tif", "categories")
    route = QgsVectorLayer("r.gpkg|layername=route", "route", "ogr")
    segments = QgsVectorLayer("r.gpkg|layername=segments", "segments", "ogr")
    assert categories.isValid() and route.isValid() and segments.isValid(), name
    for layer in (categories, route, segments):
        assert body in layer.crs().toProj(), layer.crs().toProj()
    assert categories.extent().contains(route.extent()), name
    seen = {one.label: one.color.name() for one in categories.renderer().classes()}
    assert seen == COLOURS, seen
    whole = next(route.getFeatures())
    length = sum(one.geometry().length() for one in segments.getFeatures())
    for found in (whole.geometry().length(), length):  # [m], as the program states it
        assert abs(found / whole["length_m"] - 1) < 1e-6, (found, whole["length_m"])
    assert all(one["slip"] is not None for one in segments.getFeatures()), name
    print(name, route.crs().toProj(), whole["length_m"])


if not os.path.isdir(MAPS):
    sys.exit(77)
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
application = QgsApplication([], False)
application.initQgis()
for site in SITES:
    look(sys.argv[1], *site)
sys.stdout.flush()
os._exit(0)  # skips QGIS' clean-up, which would free the layers a second time
