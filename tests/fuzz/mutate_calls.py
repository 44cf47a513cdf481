#!/usr/bin/env python3
"""Calls the program with mutated options and files and lists each call that ends otherwise than it may.

    tests/fuzz/mutate_calls.py TALUS [CALLS] [FIRST]

TALUS is the program, or call_server from a build, which saves starting it. A call may end with 0, 1 or 2, with one line of error
for 2, and may take --max-memory and 20 s of CPU time. Each call is first run unchanged, and must end with 0 or 1: what is changed
afterwards gets as far. Call k is the same in each run; FIRST goes on where a run ended. Faults are printed with their number and
the folder that they are left in; the last line has the calls, how many of them ended with 0, 1 and 2, and calls per second.
"""
import json, os, random, re, resource, shutil, subprocess, sys, tempfile, time

TALUS, CALLS, FIRST = os.path.abspath(sys.argv[1]), int((sys.argv[2:] or [1000])[0]), int((sys.argv[3:] or [0])[0])
MEMORY = 1 << 30

def grid(value, size=20):
    rows = "\n".join(" ".join("%g" % value(c, r) for c in range(size)) for r in range(size))
    return f"ncols {size}\nnrows {size}\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n{rows}\n"

FILES = {
    "dem.asc": grid(lambda c, r: round(0.03 * c + 0.01 * ((c * r) % 3), 3)),
    "classes.asc": grid(lambda c, r: 1 + (c > 10)),
    "rocks.asc": grid(lambda c, r: 0.001 * (r % 3)),
    "added.asc": grid(lambda c, r: r % 4),
    "soils.yaml": "1: soil.yaml\n2: dry_sand\n",
    "t.csv": "time_s,x_m,y_m,slope_rad,load_N,slip,torque_Nm,sinkage_m,wheel_radius_m,wheel_width_m\n" + "".join(
        f"{10 * i},{3 + 0.5 * i},10.5,{0.02 + 0.01 * (i % 5)},6.2,{0.1 + 0.02 * (i % 20)},{0.10 + 0.004 * (i % 20)},"
        f"{0.008 + 0.0003 * (i % 20)},0.065,0.08\n" for i in range(20)),
    "keep.geojson": '{"type":"Polygon","crs":"local","coordinates":[[[10,14],[12,14],[12,16],[10,14]]]}',
    "path.csv": "x_m,y_m\n3,10\n9,10\n17,11\n",
    "pairs.csv": "start_x_m,start_y_m,goal_x_m,goal_y_m\n3,10,17,10\n4,4,9,15\n",
    "soil.yaml": "name: s\ncohesion_Pa: 500\nfriction_angle_deg: 30\nsinkage_exponent: 1\ncohesive_modulus: 1400\n"
                 "frictional_modulus: 820000\nshear_modulus_m: 0.02\nc1: 0.3\nc2: 0\n",
    "rover.yaml": "name: w\nmass_kg: 10\ngravity_m_s2: 3.7\nwheels: {count: 6, radius_m: 0.065, width_m: 0.08}\n"
                  "wheelbase_m: 0.5\ntrack_m: 0.4\nclearance_m: 0.2\ncentre_of_mass_height_m: 0.2\nmax_pitch_rad: 0.5\n"
                  "max_roll_rad: 0.5\nmax_torque_Nm: 5\nmax_speed_mps: 0.1\nturning_radius_m: 0\nhotel_power_W: 10\nsteering: skid\n",
    "mission.yaml": "maps: {dem: dem.asc, resolution_m: 1, ignore_crs: true}\nsoil: soil.yaml\nrover: rover.yaml\n"
                    "start: [3, 10]\ngoal: [17, 10]\n",
    "cases.csv": "cohesion_Pa,friction_angle_rad,sinkage_exponent,sinkage_modulus,shear_modulus_m,c1,c2,wheel_radius_m,"
                 "wheel_width_m,load_N,slip\n500,0.6,1,820000,0.02,0.3,0,0.15,0.15,50,0.3\n",
    "truth.yaml": "patches:\n  - {x_m: 9, y_m: 14, radius_m: 2, soil: soil.yaml}\nrandom: {spread: 0.1, patches: 1, patch_radius_m: 2}\n",
    "runs.csv": "time_s,slope_rad,load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,grain_mm\n" + "".join(
        f"{i},0.02,{10 + i % 5},{0.05 + 0.02 * (i % 17)},{0.3 + 0.01 * (i % 13)},{0.008 + 0.0004 * (i % 11)},"
        f"{1 + 0.1 * (i % 7)},{0.3 + 0.1 * (i % 3)}\n" for i in range(16)),
}
GROUND = "dem.asc --ignore-crs --resolution 1 --soil soil.yaml --rover rover.yaml"
CLASSES = "dem.asc --ignore-crs --resolution 1 --terrain classes.asc --soils soils.yaml --rover rover.yaml"
WAY = "--start 3,10 --goal 17,10"
BASE = [f"costmap {GROUND} -o map.ot", "update map.ot t.csv -o m2.ot --journal j.db", f"plan {GROUND} {WAY} -o route.geojson"]
# Each with how often it is drawn: what takes long, less often.
CASES = [(often, words) for often, calls in {
    4: ["info dem.asc --ignore-crs --resolution 1", f"costmap {GROUND} -o out.ot --geotiff out.tif",
        "update map.ot t.csv -o out.ot --journal e.db", "update m2.ot t.csv -o out.ot --journal j.db",
        f"plan {GROUND} {WAY} --keep-out keep.geojson -o out.geojson", "plan mission.yaml -o out.geojson",
        f"plan map.ot {WAY} --risk 0.5", f"plan {CLASSES} {WAY} --rocks rocks.asc --layer a=added.asc -o out.geojson",
        f"plan map.ot --pairs pairs.csv --json", f"score {GROUND} --path path.csv", "score map.ot --path route.geojson",
        f"explain {GROUND} --at 3,10", "wheel --soil soil.yaml --rover rover.yaml --load 10 --slip 0.3",
        "wheel --cases cases.csv -o out.csv", "estimate t.csv --method wong-reece --noise 0.05", "estimate t.csv --method iagnemma",
        "estimate t.csv --method linear-offset --recursive", "assess t.csv --slope 0.1", "assess t.csv --model soil.yaml --extrapolate",
        "update map.ot --replay --journal j.db -o out.ot", "view map.ot", "view route.geojson --map map.ot --html out.html",
        "plugins plugin.so", "predict runs.csv --model soil.yaml --rover rover.yaml -o out.csv",
        "generate craters --size 32 --resolution 1 -o out.tif"],
    2: [f"plan map.ot {WAY} --planner hybrid -o out.geojson", f"drive {GROUND} --truth truth.yaml --start 3,10 --goal 8,10 --worlds 1"],
    1: ["trace runs.csv --rover rover.yaml --model-out out.yaml", "trace runs.csv --rover rover.yaml --base soil.yaml --hold-out slip=0.2..1"],
}.items() for words in calls]
NUMBERS = ["nan", "-inf", "1e308", "1e-300", "0", "-1", "1e9", "2147483648", "99999999999999999999", "0x10", "", "1e-9", "a" * 5000]
WORDS = [b"nan", b"-1", b"1e308", b"1e9", b"0", b"[" * 40, b"{", b'"', b",", b"\n", b"\xff\xff\xff\xff", b": ", b"../", b"1e-9"]

def scaled(data, dice):
    """One of the numbers of a text by a factor of 0.1 to 10, or negative: most of these are accepted."""
    numbers = list(re.finditer(rb"(?<![\w.])\d+(\.\d+)?", data))
    if not numbers: return data
    number = dice.choice(numbers)
    value = float(number.group()) * 10 ** dice.uniform(-1, 1) * dice.choice([1, 1, 1, -1])
    return data[:number.start()] + (b"%.6g" % value) + data[number.end():]

def mutated(data, dice):
    if dice.random() < 0.3: return scaled(data, dice)
    data = bytearray(data)
    for _ in range(dice.randint(1, 4)):
        at = dice.randint(0, len(data))
        kind = dice.randint(0, 4)
        if kind == 0 and data: data[at % len(data)] ^= 1 << dice.randint(0, 7)
        elif kind == 1: del data[at:at + dice.randint(1, 30)]
        elif kind == 2: data[at:at] = dice.choice(WORDS)
        elif kind == 3: data[at:at] = data[at:at + 40]
        elif dice.random() < 0.2: del data[at:]
    return bytes(data)

def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (20, 20))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

server = None
if os.path.basename(TALUS) == "call_server":
    server = subprocess.Popen([TALUS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

def call(words, folder):
    words = [*words, "--max-memory", str(MEMORY)]
    if server:
        server.stdin.write(json.dumps({"folder": folder, "words": words}) + "\n")
        server.stdin.flush()
        code, kilobytes, _ = server.stdout.readline().split()
        return int(code), open(f"{folder}/.said", errors="replace").read(), int(kilobytes) * 1024
    run = subprocess.Popen([TALUS, *words], cwd=folder, preexec_fn=limits,
                           stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = run.stderr.read().decode(errors="replace")
    _, status, used = os.wait4(run.pid, 0)
    run.returncode = os.waitstatus_to_exitcode(status)
    return run.returncode, said, used.ru_maxrss * 1024

def copied(folder, k, written):
    """A folder with the files of another: links, and copies of what a call writes."""
    new = tempfile.mkdtemp(prefix=f"call{k}-", dir=root)
    for name in os.listdir(folder):
        if name in written: shutil.copy(f"{folder}/{name}", f"{new}/{name}")
        elif not name.startswith("."): os.link(f"{folder}/{name}", f"{new}/{name}")
    return new

# In memory where the machine has such a folder.
root = tempfile.mkdtemp(prefix="talus-calls-", dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None)
base = f"{root}/base"
os.mkdir(base)
for name, text in FILES.items(): open(f"{base}/{name}", "w").write(text)
shutil.copy(TALUS, f"{base}/plugin.so")
for words in BASE:
    code, said, _ = call(words.split(), base)
    assert code == 0, (words, said)
draws = []
for often, words in CASES:
    folder = copied(base, "base", ("j.db",))
    code, said, _ = call(words.split(), folder)
    assert code in (0, 1) or words.startswith("plugins"), (words, code, said)  # a program is no plugin
    shutil.rmtree(folder)
    draws += [words] * often
faults, ends, begin = 0, [0, 0, 0], time.monotonic()
for k in range(FIRST, FIRST + CALLS):
    dice = random.Random(k)
    words = dice.choice(draws).split()
    folder = copied(base, k, ("j.db",))
    files = [w for w in words if os.path.exists(f"{folder}/{w}")]
    if files and dice.random() < 0.7:
        victim = dice.choice(files)
        data = open(f"{folder}/{victim}", "rb").read()
        os.remove(f"{folder}/{victim}")
        open(f"{folder}/{victim}", "wb").write(mutated(data, dice))
    else:
        at = dice.randrange(1, len(words))
        words[at] = dice.choice(NUMBERS) if dice.random() < 0.8 else dice.choice(words)
    code, said, memory = call(words, folder)
    errors = [line for line in said.splitlines() if not line.startswith("talus: warning")]
    partial = [name for name in os.listdir(folder) if name.startswith("out.")] if code == 2 else []
    if code in (0, 1, 2): ends[code] += 1
    if code not in (0, 1, 2) or memory > 1.2 * MEMORY or (code == 2 and len(errors) != 1) or partial:
        faults += 1
        print(f"{k}: exit {code}, {memory >> 20} MB, {partial}: {' '.join(w[:60] for w in words)}\n    {said[-300:].strip()}\n    {folder}", flush=True)
    else:
        shutil.rmtree(folder)
seconds = time.monotonic() - begin
print(f"{CALLS} calls from {FIRST}, {faults} faults; exit 0, 1, 2: {ends}; {CALLS / max(seconds, 1e-9):.1f} calls a second", flush=True)
if server: server.stdin.close()
if not faults: shutil.rmtree(root)
sys.exit(1 if faults else 0)
