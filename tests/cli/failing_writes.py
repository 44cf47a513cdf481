"""What a failed write, fsync, rename or truncate leaves of the files: failing_writes.py TALUS FAILING_IO LIBTALUS [PYTHONPATH].

Each call runs once to count its operations, then with one operation that fails, or all from there on. It must end by 2 with one line that
names a file and the system's reason; each file must be as before, and no other file may be left. Of several files that belong together,
those renamed before a failed rename may be new. The calls where an operation fails are a seeded sample.
"""
import concurrent.futures
import errno
import os
import random
import shutil
import subprocess
import sys

TALUS, FAILING_IO, LIBTALUS = (os.path.abspath(path) for path in sys.argv[1:4])
UTM_11N = ('PROJCS["WGS 84 / UTM zone 11N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
           'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
           'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",-117],PARAMETER["scale_factor",0.9996],'
           'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]')
CASES = "cohesion_Pa,friction_angle_rad,sinkage_exponent,sinkage_modulus,shear_modulus_m,c1,c2,wheel_radius_m,wheel_width_m,load_N,slip\n"
C_SAVE = """if True:
    import ctypes, sys
    talus, error = ctypes.CDLL(sys.argv[2]), ctypes.create_string_buffer(256)
    options, session = ctypes.create_string_buffer(256), ctypes.c_uint64()
    talus.talus_default_options(options)
    assert talus.talus_open(b"../map.ot", options, ctypes.byref(session), error) == 0, error.value
    code = talus.talus_save(session, sys.argv[1].encode(), error)
    sys.exit(print(error.value.decode(), file=sys.stderr) or code if code else 0)"""
PYTHON_SAVE = """if True:
    import sys, talus
    try:
        talus.Map.read("../map.ot").save(sys.argv[1])
    except talus.InputError as error:
        sys.exit(print(error, file=sys.stderr) or 2)"""
GROUND = ["../dem.asc", "--rover", "sojourner", "--soil", "sandy_loam"]
PLAN = [TALUS, "plan", *GROUND, "--start", "500005,4000005", "--goal", "500025,4000025", "--no-proof"]
UPDATE = [TALUS, "update", "../map.ot", "../drive.csv"]
MODEL = ["--model", "sandy_loam", "--rover", "sojourner"]
# The call, the files that it writes, of which the first is its last argument, and the number of trials.
CALLS = [
    ([TALUS, "generate", "craters", "--size", "20", "-o"], ["s.tif", "s_classes.tif", "s_rocks.tif", "s_soils.yaml"], 5),
    ([TALUS, "costmap", *GROUND, "-o"], ["m.ot"], 10),
    ([*UPDATE, "-o"], ["m.ot"], 10),
    ([*UPDATE, "--journal", "j.db", "-o"], ["m.ot"], 15),
    ([sys.executable, "-c", C_SAVE, "LAST", LIBTALUS], ["m.ot"], 4),
    *[([sys.executable, "-c", PYTHON_SAVE], ["m.ot"], 4) for _ in sys.argv[4:]],
    ([TALUS, "costmap", *GROUND, "--octovis"], ["o.ot"], 4),
    ([TALUS, "costmap", *GROUND, "--geotiff"], ["l.tif", "l.qml"], 4),
    ([TALUS, "costmap", *GROUND, "--categories"], ["c.tif", "c.qml"], 4),
    ([TALUS, "costmap", *GROUND, "--nav2"], ["n.yaml", "n.pgm"], 4),
    ([TALUS, "costmap", *GROUND, "--png"], ["c.png"], 2),
    ([TALUS, "costmap", *GROUND, "--unsafe"], ["u.gpkg"], 2),
    ([*PLAN, "--corridor", "5", "-o"], ["a.gpkg"], 2),
    *[([*PLAN, "-o"], [f"r.{form}"], 2) for form in ("geojson", "gpkg", "gpx", "kml", "csv")],
    *[([*PLAN, option], [name], 2) for option, name in (("--png", "r.png"), ("--html", "r.html"))],
    ([TALUS, "view", "../map.ot", "-o"], ["v.html"], 2),
    ([TALUS, "drive", *GROUND, "--truth", "../truth.yaml", "--start", "500005,4000005", "--goal", "500009,4000009", "--telemetry"],
     ["t.csv"], 2),
    ([TALUS, "wheel", "--cases", "../cases.csv", "-o"], ["w.csv"], 5),
    ([TALUS, "predict", "../drive.csv", *MODEL, "-o"], ["p.csv"], 2),
    ([TALUS, "trace", "../runs.csv", "--base", "../base.yaml", "--html"], ["t.html"], 2),
    ([TALUS, "bench", "../room.scen", "--planners", "field", "--runs", "1", "-o"], [".", "room_1.log", "table.txt", "index.html"], 3),
    ([TALUS, "init", "../dem.asc", "--force", "-o"], ["mission.yaml"], 2),
]


def write(name, text):
    with open(name, "w") as file:
        file.write(text)


def content(name):
    with open(name, "rb") as file:
        return file.read()


def make_inputs():
    rows = [" ".join(f"{0.02 * (column + row) + 0.01 * (column * row % 7):.2f}" for column in range(40)) for row in range(40)]
    write("dem.asc", "ncols 40\nnrows 40\nxllcorner 500000\nyllcorner 4000000\ncellsize 1\n" + "\n".join(rows) + "\n")
    write("dem.prj", UTM_11N)
    write("cases.csv", CASES + "500,0.6,1,820000,0.02,0.3,0,0.15,0.15,50,0.3\n" * 500)
    drive = [f"{row},{500003 + 0.3 * row},4000010.5,0.02,10,{0.3 + 0.001 * (row % 7)}\n" for row in range(60)]
    write("drive.csv", "time_s,x_m,y_m,slope_rad,load_N,slip\n" + "".join(drive))
    runs = [f"{60 + 8 * (row % 6)},{0.1 + 0.05 * (row % 11):.2f},{5 + row % 5},{0.01 + 0.001 * (row % 7):.3f},{10 + row % 9},0.1,0.1\n"
            for row in range(60)]
    write("runs.csv", "load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,wheel_width_m\n" + "".join(runs))
    write("base.yaml", "{soil: sandy_loam, model: wong-reece}\n")
    write("truth.yaml", "terrain_classes: {0: sandy_loam}\n")
    write("room.map", "type octile\nheight 6\nwidth 8\nmap\n........\n..@@@@..\n..@@@@..\n..@@@@..\n........\n........\n")
    write("room.scen", "version 1\n0\troom.map\t8\t6\t0\t2\t7\t2\t9\n")
    subprocess.run([TALUS, "costmap", *[word.replace("../", "") for word in GROUND], "-o", "map.ot", "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)


def run(words, files, folder, **fault):
    last = ["--quiet"] if words[0] == TALUS else []
    call = [files[0] if word == "LAST" else word for word in words] + ([] if "LAST" in words else [files[0]]) + last
    return subprocess.run(call, cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "LD_PRELOAD": FAILING_IO, "PYTHONDONTWRITEBYTECODE": "1",
                               "PYTHONPATH": os.pathsep.join(sys.argv[4:]), **fault})


def fresh(folder, files):
    os.makedirs(folder)
    for name in files:
        write(os.path.join(folder, name), "old")


def trial(words, files, good, operations, chosen, lasting, reason, folder):
    """One run with a fault; the text of the fault that was found, or nothing."""
    names = [name for name in files if name != "."]
    fresh(folder, names)
    fault = {"IO_FAIL": str(chosen), "IO_ERRNO": str(reason), **({"IO_ALL": "1"} if lasting else {})}
    ran = run(words, files, folder, **fault)
    lines = ran.stderr.splitlines()
    wrong = []
    journal = "j.db" in words
    left = [name for name in sorted(os.listdir(folder)) if not (journal and name.startswith("j.db"))]
    renamed = operations[:chosen - 1].count("rename")
    # What SQLite cannot write into the journal stays in the file beside it: the call is done.
    if ran.returncode not in ((0, 2) if journal else (2,)) or len(lines) != (ran.returncode == 2):
        wrong.append("not exit 2 with one line")
    if ran.returncode == 2 and not journal and os.strerror(reason) not in ran.stderr:
        wrong.append("no reason")
    if left != sorted(names):
        wrong.append(f"left {left}")
    for name in names:
        now = content(os.path.join(folder, name))
        if not (now == b"old" and ran.returncode == 2 or good[name] in (None, now) and (ran.returncode == 0 or renamed)):
            wrong.append(f"{name} is neither old nor whole")
    if journal:
        again = run(words, files, folder)
        if again.returncode != 0 or content(os.path.join(folder, "m.ot")) != good["m.ot"]:
            wrong.append(f"a second call does not mend it: {again.returncode} {again.stderr}")
    shutil.rmtree(folder)
    call = f"{' '.join(words[1:4])} {files}: {'each from' if lasting else 'only'} {chosen} ({operations[chosen - 1]}) of {len(operations)}"
    return f"{call}, {os.strerror(reason)}: {', '.join(wrong)}; exit {ran.returncode} {ran.stderr!r}" if wrong else ""


def main():
    make_inputs()
    random.seed(1)
    trials = []
    for number, (words, files, count) in enumerate(CALLS):
        names = [name for name in files if name != "."]
        fresh("good", names)
        run(words, files, "good")  # fills caches of the libraries
        for name in os.listdir("good"):
            os.remove(os.path.join("good", name))
        ran = run(words, files, "good", IO_LOG="1")
        assert ran.returncode in (0, 1), (words, ran)  # 1: `trace` names no effect
        operations = ran.stderr.split()
        good = {name: content(os.path.join("good", name)) if "bench" not in words else None for name in names}
        shutil.rmtree("good")
        assert operations.count("rename") == len(names) and {"write", "writev"} & set(operations) and "fsync" in operations, (words, operations)
        print(f"{' '.join(files)}: {len(operations)} operations")
        faults = [(n, lasting, reason) for n in range(1, len(operations) + 1) for lasting in (False, True)
                  for reason in (errno.ENOSPC, errno.EIO)]
        for n, fault in enumerate(random.sample(faults, min(count, len(faults)))):
            trials.append((words, files, good, operations, *fault, f"run{number}_{n}"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [text for text in pool.map(lambda given: trial(*given), trials) if text]
    with open("/dev/full", "w") as full:
        ran = subprocess.run([TALUS, "info", "dem.asc", "--json"], stdout=full, stderr=subprocess.PIPE, text=True)
    if ran.returncode != 2 or os.strerror(errno.ENOSPC) not in ran.stderr:
        wrong.append(f"info --json > /dev/full: {ran.returncode} {ran.stderr!r}")
    print(*wrong, f"{len(trials)} faults tried, {len(wrong)} wrong", sep="\n")
    sys.exit(bool(wrong))


shutil.rmtree("failing_writes", ignore_errors=True)
os.makedirs("failing_writes")
os.chdir("failing_writes")
main()
