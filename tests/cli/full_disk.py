"""What a disk that fills up leaves of the program's files: full_disk.py TALUS, in a folder of its own.

Each call writes onto a disk of 1, 2 ... pages until all of it fits. Until then it ends by 2, gives the system's reason, and leaves no file
of its own: none in part, and of several that belong together not one alone. The disk is a tmpfs; where none can be mounted, a limit of
the size of each file takes its place.
"""
import errno
import os
import resource
import subprocess
import sys

PAGE = 4096
DISK = os.path.abspath("disk")
UTM_11N = ('PROJCS["WGS 84 / UTM zone 11N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
           'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
           'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",-117],PARAMETER["scale_factor",0.9996],'
           'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]')
CASES = ("cohesion_Pa,friction_angle_rad,sinkage_exponent,sinkage_modulus,shear_modulus_m,c1,c2,wheel_radius_m,wheel_width_m,load_N,slip\n"
         "500,0.6,1,820000,0.02,0.3,0,0.15,0.15,50,0.3\n")
GROUND = ["dem.asc", "--rover", "sojourner", "--soil", "sandy_loam"]
PLAN = ["plan", *GROUND, "--start", "500005,4000005", "--goal", "500025,4000025", "--no-proof"]
# The arguments of the call without its output, and the files that the call writes.
CALLS = [
    (["generate", "craters", "--size", "20", "-o"], ["s.tif", "s_classes.tif", "s_rocks.tif", "s_soils.yaml"]),
    (["costmap", *GROUND, "-o"], ["m.ot"]),
    (["costmap", *GROUND, "--octovis"], ["o.ot"]),
    (["costmap", *GROUND, "--geotiff"], ["l.tif"]),
    (["costmap", *GROUND, "--categories"], ["c.tif", "c.qml"]),
    (["costmap", *GROUND, "--nav2"], ["n.yaml", "n.pgm"]),
    (["costmap", *GROUND, "--png"], ["c.png"]),
    (["explain", *GROUND, "--at", "500005,4000005", "--png"], ["e.svg"]),
    *[([*PLAN, "-o"], [f"r.{form}"]) for form in ("geojson", "gpkg", "gpx", "kml", "csv")],
    ([*PLAN, "--png"], ["r.png"]),
    ([*PLAN, "--html"], ["r.html"]),
    (["wheel", "--soil", "sandy_loam", "--rover", "sojourner", "--load", "20", "--slip", "0.2", "--html"], ["w.html"]),
    (["wheel", "--cases", "cases.csv", "-o"], ["w.csv"]),
    (["init", "dem.asc", "-o"], ["mission.yaml"]),
]


def make_inputs():
    rows = [" ".join(f"{0.02 * (column + row):.2f}" for column in range(40)) for row in range(40)]
    with open("dem.asc", "w") as file:
        file.write("ncols 40\nnrows 40\nxllcorner 500000\nyllcorner 4000000\ncellsize 1\n" + "\n".join(rows) + "\n")
    with open("dem.prj", "w") as file:
        file.write(UTM_11N)
    with open("cases.csv", "w") as file:
        file.write(CASES)


def mount(pages):
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={pages * PAGE}", "none", DISK], check=True)


def limit(pages):
    # One byte more than whole memory pages, so that no file ends at the limit.
    resource.setrlimit(resource.RLIMIT_FSIZE, (pages * PAGE + 1, resource.RLIM_INFINITY))


def run(talus, words, files, pages, mounted):
    """Whether all of it fitted."""
    if mounted:
        mount(pages)
    ran = subprocess.run([talus, *words, os.path.join(DISK, files[0]), "--quiet"], capture_output=True, text=True,
                         preexec_fn=None if mounted else lambda: limit(pages))
    left = sorted(os.listdir(DISK))
    for name in left if not mounted else []:
        os.remove(os.path.join(DISK, name))
    if mounted:
        subprocess.run(["umount", DISK], check=True)
    call = f"{' '.join(words)} {files[0]}, {pages} pages: {ran.returncode} {ran.stderr!r} {left}"
    reason = os.strerror(errno.ENOSPC if mounted else errno.EFBIG)
    if ran.returncode == 0:
        assert left == sorted(files), call
        return True
    assert ran.returncode == 2, call
    assert left == [], call
    assert reason in ran.stderr and files[0].split(".")[0] in ran.stderr, call
    return False


def main(talus, mounted):
    os.makedirs(DISK, exist_ok=True)
    make_inputs()
    wrong = []
    for words, files in CALLS:
        pages = 1
        try:
            while not run(talus, words, files, pages, mounted):
                pages += 1 if len(files) > 1 else pages
            print(f"{' and '.join(files)}: whole on {pages} pages")
        except AssertionError as error:
            wrong.append(str(error))
            print("FAILED", error)
    with open("/dev/full", "w") as full:
        ran = subprocess.run([talus, "info", "dem.asc", "--json"], stdout=full, stderr=subprocess.PIPE, text=True)
    if ran.returncode == 0 or os.strerror(errno.ENOSPC) not in ran.stderr:
        wrong.append(f"info --json > /dev/full: {ran.returncode} {ran.stderr!r}")
        print("FAILED", wrong[-1])
    sys.exit(1 if wrong else 0)


if sys.argv[-1] == "--mounted":
    main(sys.argv[1], True)
for how in (["unshare", "--mount"], ["unshare", "--map-root-user", "--mount"]):
    tried = subprocess.run([*how, "mount", "-t", "tmpfs", "none", os.getcwd()], capture_output=True)
    if tried.returncode == 0:
        sys.exit(subprocess.run([*how, sys.executable, *sys.argv, "--mounted"]).returncode)
print("no tmpfs can be mounted here: each file is limited instead")
main(sys.argv[1], False)
