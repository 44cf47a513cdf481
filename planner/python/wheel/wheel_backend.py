"""The hooks of PEP 517 by CMake alone, so that `pip install .` works without a network."""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

VERSION = re.search(r"project\(talus VERSION ([0-9.]+)", open("CMakeLists.txt", encoding="utf-8").read()).group(1)
METADATA = f"Metadata-Version: 2.1\nName: talus\nVersion: {VERSION}\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"


def _installed(prefix):
    build = os.environ.get("TALUS_BUILD", "")  # a build of `./dev`, which is then taken as it is
    if not build:
        build = os.path.join("build", "wheel")
        options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DTALUS_UNITY=ON", "-DTALUS_TESTS=OFF",
                   f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_REQUIRE_FIND_PACKAGE_pybind11=ON"]
        subprocess.run(["cmake", "-S", ".", "-B", build, *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "talus_python"], check=True)
    subprocess.run(["cmake", "--install", build, "--component", "python3-talus", "--prefix", prefix, "--strip"], check=True)
    for folder, _, names in os.walk(prefix):
        for name in names if os.path.basename(folder) == "talus" and "__init__.py" in names else ():
            path = os.path.join(folder, name)
            with open(path, "rb") as file:
                yield os.path.join("talus", name), file.read()


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
    archive = f"talus-{VERSION}.tar.gz"
    with tempfile.TemporaryDirectory() as folder:
        info = os.path.join(folder, "PKG-INFO")
        with open(info, "w", encoding="utf-8") as file:
            file.write(METADATA)
        subprocess.run(["git", "archive", f"--prefix=talus-{VERSION}/", f"--add-file={info}", "-o",
                        os.path.join(sdist_directory, archive), "HEAD"], check=True)
    return archive
