#!/usr/bin/env python3
"""Calls the program with mutated options and files and lists each call that ends otherwise than it may.

    tests/fuzz/mutate_calls.py TALUS [CALLS] [FIRST]

A call may end with 0, 1 or 2, with one line of error for 2, and may take --max-memory and 20 s of CPU time. Call k is the same
in each run; FIRST goes on where a run ended. Faults are printed with their number and the folder that they are left in.
"""
import os, random, resource, shutil, subprocess, sys, tempfile

TALUS, CALLS, FIRST = os.path.abspath(sys.argv[1]), int((sys.argv[2:] or [1000])[0]), int((sys.argv[3:] or [0])[0])
MEMORY = 1 << 30

def grid(width, height, cell="1"):
    rows = "\n".join(" ".join("%.2f" % (0.1 * ((c * r) % 7)) for c in range(width)) for r in range(height))
    return f"ncols {width}\nnrows {height}\nxllcorner 0\nyllcorner 0\ncellsize {cell}\nNODATA_value -9999\n{rows}\n"

FILES = {
    "dem.asc": grid(30, 30),
    "t.csv": "time_s,x_m,y_m,slope_rad,load_N,slip,torque_Nm,sinkage_m\n" + "".join(
        f"{i},{5 + 0.5 * i},20.5,0.02,10,{0.3 + 0.001 * (i % 7)},0.5,0.01\n" for i in range(30)),
    "keep.geojson": '{"type":"Polygon","crs":"local","coordinates":[[[10,10],[12,10],[12,12],[10,10]]]}',
    "path.csv": "x_m,y_m\n5,20\n15,20\n25,21\n",
    "soil.yaml": "name: s\ncohesion_Pa: 500\nfriction_angle_deg: 30\nsinkage_exponent: 1\ncohesive_modulus: 1400\n"
                 "frictional_modulus: 820000\nshear_modulus_m: 0.02\nc1: 0.3\nc2: 0\n",
    "rover.yaml": "name: w\nmass_kg: 10\ngravity_m_s2: 3.7\nwheels: {count: 6, radius_m: 0.065, width_m: 0.08}\n"
                  "wheelbase_m: 0.5\ntrack_m: 0.4\nclearance_m: 0.2\ncentre_of_mass_height_m: 0.2\nmax_pitch_rad: 0.5\n"
                  "max_roll_rad: 0.5\nmax_torque_Nm: 5\nmax_speed_mps: 0.1\nturning_radius_m: 0\nhotel_power_W: 10\nsteering: skid\n",
    "mission.yaml": "maps: {dem: dem.asc, resolution_m: 1, ignore_crs: true}\nsoil: soil.yaml\nrover: rover.yaml\n"
                    "start: [5, 20]\ngoal: [25, 20]\n",
    "cases.csv": "cohesion_Pa,friction_angle_rad,sinkage_exponent,sinkage_modulus,shear_modulus_m,c1,c2,wheel_radius_m,"
                 "wheel_width_m,load_N,slip\n500,0.6,1,820000,0.02,0.3,0,0.15,0.15,50,0.3\n",
    "truth.yaml": "patches:\n  - {x_m: 15, y_m: 20, radius_m: 2, soil: soil.yaml}\nrandom: {spread: 0.1, patches: 1, patch_radius_m: 2}\n",
    "runs.csv": "time_s,slope_rad,load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,grain_mm\n" + "".join(
        f"{i},0.02,{10 + i % 5},{0.05 + 0.02 * (i % 17)},{0.3 + 0.01 * (i % 13)},{0.008 + 0.0004 * (i % 11)},"
        f"{1 + 0.1 * (i % 7)},{0.3 + 0.1 * (i % 3)}\n" for i in range(60)),
}
GROUND = "dem.asc --ignore-crs --resolution 1 --soil soil.yaml --rover rover.yaml"
CASES = [
    f"info dem.asc --ignore-crs --resolution 1", f"costmap {GROUND} -o out.ot --geotiff out.tif", f"update map.ot t.csv -o out.ot --journal e.db",
    f"plan {GROUND} --start 5,20 --goal 25,20 --keep-out keep.geojson -o out.geojson", f"plan mission.yaml -o out.geojson",
    f"plan map.ot --start 5,20 --goal 25,20 --risk 0.5", f"score {GROUND} --path path.csv", f"explain {GROUND} --at 5,20",
    "wheel --soil soil.yaml --rover rover.yaml --load 10 --slip 0.3 --html out.html", "wheel --cases cases.csv -o out.csv",
    "estimate t.csv --method wong-reece --noise 0.05", "estimate t.csv --method iagnemma", "assess t.csv --slope 0.1",
    "update map.ot --replay --journal j.db -o out.ot", "view map.ot --html out.html", "plugins plugin.so",
    "trace runs.csv --rover rover.yaml --model-out out.yaml", "trace runs.csv --rover rover.yaml --base soil.yaml --hold-out slip=0.2..1",
    "predict runs.csv --model soil.yaml --rover rover.yaml -o out.csv", "generate craters --size 32 --resolution 1 -o out.tif",
    f"drive {GROUND} --truth truth.yaml --start 5,20 --goal 10,20 --worlds 1",
]
NUMBERS = ["nan", "-inf", "1e308", "1e-300", "0", "-1", "1e9", "2147483648", "99999999999999999999", "0x10", "", "1e-9", "a" * 5000]
WORDS = [b"nan", b"-1", b"1e308", b"1e9", b"0", b"[" * 40, b"{", b'"', b",", b"\n", b"\xff\xff\xff\xff", b": ", b"../", b"1e-9"]

def mutated(data, dice):
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

def call(words, folder):
    run = subprocess.Popen([TALUS, *words, "--max-memory", str(MEMORY)], cwd=folder, preexec_fn=limits,
                           stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = run.stderr.read().decode(errors="replace")
    _, status, used = os.wait4(run.pid, 0)
    run.returncode = os.waitstatus_to_exitcode(status)
    return run.returncode, said, used.ru_maxrss * 1024

base = tempfile.mkdtemp(prefix="talus-calls-")
for name, text in FILES.items(): open(f"{base}/{name}", "w").write(text)
for words in (f"costmap {GROUND} -o map.ot", "update map.ot t.csv -o m2.ot --journal j.db"):
    code, said, _ = call(words.split(), base)
    assert code == 0, said
shutil.copy(TALUS, f"{base}/plugin.so")
faults = 0
for k in range(FIRST, FIRST + CALLS):
    dice = random.Random(k)
    words = dice.choice(CASES).split()
    folder = tempfile.mkdtemp(prefix=f"call{k}-", dir=base)
    for name in os.listdir(base):
        if os.path.isfile(f"{base}/{name}"): os.link(f"{base}/{name}", f"{folder}/{name}")
    files = [w for w in words if os.path.exists(f"{folder}/{w}")]
    if files and dice.random() < 0.7:
        victim = dice.choice(files)
        data = open(f"{folder}/{victim}", "rb").read()
        os.remove(f"{folder}/{victim}")
        open(f"{folder}/{victim}", "wb").write(mutated(data, dice))
    else:
        at = dice.randrange(1, len(words))
        words[at] = dice.choice(NUMBERS) if dice.random() < 0.8 else dice.choice(words)
    for name in ("j.db", "e.db"):  # written by the call: no link to the base's
        if os.path.exists(f"{folder}/{name}"): shutil.copy(f"{folder}/{name}", f"{folder}/.x"); os.replace(f"{folder}/.x", f"{folder}/{name}")
    code, said, memory = call(words, folder)
    errors = [line for line in said.splitlines() if not line.startswith("talus: warning")]
    if code not in (0, 1, 2) or memory > 1.2 * MEMORY or (code == 2 and len(errors) != 1):
        faults += 1
        print(f"{k}: exit {code}, {memory >> 20} MB: {' '.join(w[:60] for w in words)}\n    {said[-300:].strip()}\n    {folder}", flush=True)
    else:
        shutil.rmtree(folder)
print(f"{CALLS} calls from {FIRST}, {faults} faults")
if not faults: shutil.rmtree(base)
sys.exit(1 if faults else 0)
