"""The hooks of PEP 517 by CMake alone, so that `pip install .` works without a network."""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

VERSION = re.search(r"project\(talus VERSION ([0-9.]+)", open("CMakeLists.txt", encoding="utf-8").read()).group(1)
METADATA = f"Metadata-Version: 2.1\nName: talus\nVersion: {VERSION}\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"


def _installed(prefix):
    build = os.path.join("build", "wheel")
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DTALUS_UNITY=ON", "-DTALUS_TESTS=OFF", "-DTALUS_PYTHON_DIR=.",
               f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_REQUIRE_FIND_PACKAGE_pybind11=ON"]
    subprocess.run(["cmake", "-S", ".", "-B", build, *options], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "talus_python"], check=True)
    subprocess.run(["cmake", "--install", build, "--component", "python3-talus", "--prefix", prefix, "--strip"], check=True)
    for folder, _, names in os.walk(os.path.join(prefix, "talus")):
        for name in names:
            path = os.path.join(folder, name)
            with open(path, "rb") as file:
                yield os.path.relpath(path, prefix), file.read()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tags = f"{tag}-{tag}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    info = f"talus-{VERSION}.dist-info"
    with tempfile.TemporaryDirectory() as prefix:
        files = dict(_installed(prefix))
    files[f"{info}/METADATA"] = METADATA.encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: talus\nRoot-Is-Purelib: false\nTag: {tags}\n".encode()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"talus-{VERSION}-{tags}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    name = f"talus-{VERSION}"
    with tarfile.open(os.path.join(sdist_directory, name + ".tar.gz"), "w:gz") as archive:
        for file in subprocess.run(["git", "ls-files"], check=True, capture_output=True, text=True).stdout.split():
            archive.add(file, f"{name}/{file}")
        with tempfile.NamedTemporaryFile("w") as info:
            info.write(METADATA)
            info.flush()
            archive.add(info.name, f"{name}/PKG-INFO")
    return name + ".tar.gz"
