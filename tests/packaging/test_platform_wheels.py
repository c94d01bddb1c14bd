# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheels and zips of `package --platforms`: their content, and runs of those for Windows and Linux.

Windows' run under Wine: the C++ tests, the module's tests, the extension installed in Blender for Windows. Those for
Linux on ARM run under qemu, where it is installed: the module's tests.
"""

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from tests.module import meshes, processor
from tests.packaging.test_packages import SCRIPT, check_unwrapped
from tools import environment, packaging
from tools.cross import command, native, notes, qemu, targets, wheels, wine
from tools.wheels import python_tag

if not command.made():
    pytest.skip(
        "no wheels of other platforms: make them by `python3 build_addon.py package --platforms all`",
        allow_module_level=True,
    )
lief = pytest.importorskip("lief")

ROOT = Path(__file__).resolve().parents[2]
MADE = [(target, python) for target in command.made() for python in targets.PYTHONS]
EXAMPLES = Path(__file__).with_name("example_maps.py")
# What a module may need beside OpenBLAS: what every system has, and what Python brings along.
SYSTEM_LIBRARIES = {
    "Windows": r"KERNEL32\.dll|msvcrt\.dll|python3\d+\.dll",
    "Linux": r"lib(c|m|dl|pthread|rt)\.so\.\d|ld-linux-[\w-]+\.so\.\d",
    "Darwin": r"/usr/lib/libSystem\.B\.dylib",
}
# In a symbol of Mach-O, the number of the library that stands for any that the process has loaded.
DYNAMIC_LOOKUP = 0xFE
NEWEST_GLIBC = (2, 28)
# Folders of the machine that compiled.
FOREIGN_PATHS = (str(ROOT).encode(), b"/usr/include", b"/root/", b"/home/", b"/tmp/")

every_wheel = pytest.mark.parametrize(
    ("target", "python"), MADE, ids=[f"{target.name}-{python}" for target, python in MADE]
)


def target_or_skip(name):
    """Return a target, or skip the test when it has no wheels."""
    found = [target for target in command.made() if target.name == name]
    if not found:
        pytest.skip(f"no wheels: make them by `python3 build_addon.py package --platforms {name}`")
    return found[0]


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    """Return the function that unpacks a wheel, once, and checks the hashes in its list of files."""
    folders = {}

    def unpack(target, python):
        wheel = wheels.wheel(target, python)
        if wheel not in folders:
            folder = tmp_path_factory.mktemp("wheel")
            call = [environment.PYTHON, "-m", "wheel", "unpack", "--dest", folder, wheel]
            result = subprocess.run(call, capture_output=True, text=True, check=False)
            assert result.returncode == 0, result.stderr
            (folders[wheel],) = folder.iterdir()
        return folders[wheel]

    return unpack


def binaries(target, python, folder):
    """Return the paths of the native module and of OpenBLAS in an unpacked wheel."""
    package = folder / "spectral_conformal"
    return package / target.module_name(python), package / target.blas_name


@every_wheel
def test_wheel_has_its_tag_module_blas_and_licenses(target, python, unpacked):
    folder = unpacked(target, python)
    (information,) = folder.glob("*.dist-info")
    tag = python_tag(python)
    assert f"Tag: {tag}-{tag}-{target.tag}\n" in (information / "WHEEL").read_text()
    assert all(path.is_file() for path in binaries(target, python, folder))
    texts = {path.name: path.read_text(errors="replace") for path in (information / "licenses").iterdir()}
    expected = ["LICENSE", "boost", "cgal", "eigen", "metis", "openblas", "pybind11", "suitesparse-cholmod"]
    expected += ["mingw", "libgcc"] if target.system == "Windows" else ["llvm-libcxx", "llvm-libcxxabi"]
    for name in expected:
        assert [text for file, text in texts.items() if file.startswith(name) and len(text) > 500], name
    assert "GENERAL PUBLIC LICENSE" in texts["LICENSE"]


@every_wheel
def test_module_needs_openblas_and_the_bare_system_only(target, python, unpacked):
    module, blas = binaries(target, python, unpacked(target, python))
    for path in (module, blas):
        needed = set(libraries(lief.parse(str(path))))
        allowed = re.compile(SYSTEM_LIBRARIES[target.system] + r"|api-ms-win-crt-[\w-]+\.dll", re.IGNORECASE)
        others = {name for name in needed if not allowed.fullmatch(name)}
        beside = f"@loader_path/{target.blas_name}" if target.system == "Darwin" else target.blas_name
        assert others == ({beside} if path == module else set())


def libraries(binary):
    """Return the names of the libraries that a binary needs, as they stand in it."""
    if isinstance(binary, lief.MachO.Binary):
        own = lief.MachO.LoadCommand.TYPE.ID_DYLIB
        return [library.name for library in binary.libraries if library.command != own]
    return [name if isinstance(name, str) else name.name for name in binary.libraries]


@every_wheel
def test_module_is_of_the_targets_format_and_shows_its_one_function(target, python, unpacked):
    module, blas = binaries(target, python, unpacked(target, python))
    content = module.read_bytes()
    assert [path for path in FOREIGN_PATHS if path in content] == []
    binary = lief.parse(str(module))
    if target.system == "Windows":
        assert binary.header.machine.name == "AMD64"
        assert [entry.name for entry in binary.get_export().entries] == ["PyInit__native"]
        assert binary.header.time_date_stamps == 0
    elif target.system == "Linux":
        assert binary.header.machine_type.name == target.processor.upper()
        shown = [symbol.name for symbol in binary.exported_symbols]
        assert shown == ["PyInit__native"]
        assert binary.get(lief.ELF.DynamicEntry.TAG.RUNPATH).runpath == "$ORIGIN"
        for path in (module, blas):
            assert max(glibc_versions(lief.parse(str(path)))) <= NEWEST_GLIBC
    else:
        assert [symbol.name for symbol in binary.exported_symbols] == ["_PyInit__native"]


def glibc_versions(binary):
    """Return the versions of glibc that an ELF file asks for."""
    names = [aux.name for required in binary.symbols_version_requirement for aux in required.get_auxiliary_symbols()]
    return [tuple(map(int, name[6:].split("."))) for name in names if re.fullmatch(r"GLIBC_[\d.]+", name)]


@pytest.mark.parametrize(
    ("target", "python"),
    [pair for pair in MADE if pair[0].system == "Darwin"],
    ids=lambda value: getattr(value, "name", value),
)
def test_bundle_for_macos(target, python, unpacked):
    module, blas = binaries(target, python, unpacked(target, python))
    bundle = lief.parse(str(module))
    assert bundle.header.file_type == lief.MachO.Header.FILE_TYPE.BUNDLE
    processor = {"arm64": lief.MachO.Header.CPU_TYPE.ARM64, "x86_64": lief.MachO.Header.CPU_TYPE.X86_64}
    for path in (module, blas):
        binary = lief.parse(str(path))
        assert binary.header.cpu_type == processor[target.processor]
        assert list(lowest_system(binary))[:2] <= [11, 0]
        # Macs with ARM refuse code that is not signed at all.
        assert binary.has_code_signature or target.processor == "x86_64"
    assert list(lowest_system(bundle))[:2] == [11, 0]
    assert not bundle.rpaths
    # Python's functions are found in the process, all else in a library that is named.
    free = [symbol.name for symbol in bundle.imported_symbols if symbol.library_ordinal & 0xFF == DYNAMIC_LOOKUP]
    assert free, "no symbol is left to the process that loads the module"
    assert [name for name in free if not name.startswith(("_Py", "__Py"))] == []


def lowest_system(binary):
    """Return the version of macOS that a binary needs at least."""
    return binary.build_version.minos if binary.has_build_version else binary.version_min.version


@pytest.fixture(scope="module")
def zips(tmp_path_factory):
    return make_zips(tmp_path_factory.mktemp("zips"))


def make_zips(folder):
    """Write the zips of all wheels that there are, and return them by name."""
    source = folder / "wheels"
    source.mkdir()
    for target, python in MADE:
        wheel = wheels.wheel(target, python)
        (source / wheel.name).symlink_to(wheel)
    texts = {target.name: notes.text(target, packaging.version()) for target in command.made()}
    packaging.run_with_wheels(source, folder / "zips", texts)
    return {path.name: path for path in (folder / "zips").iterdir()}


def test_every_platform_gets_one_extension_and_two_legacy_zips(zips):
    start = f"spectral_unwrap-{packaging.version()}"
    names = [target.name.replace("-", "_") for target in command.made()]
    legacy = [f"{start}-legacy-{name}-{python}.zip" for name in names for python in packaging.LEGACY_PYTHONS]
    assert sorted(zips) == sorted([f"{start}-{name}.zip" for name in names] + legacy)


def test_zips_have_notes_and_the_licenses_of_all_that_they_bring(zips):
    for name, path in zips.items():
        with zipfile.ZipFile(path) as archive:
            members = archive.namelist()
            root = "spectral_unwrap/" if "-legacy-" in name else ""
            text = archive.read(f"{root}NOTES.txt").decode()
            if root:
                assert f"{root}licenses/openblas-and-libgfortran.txt" in members
            else:
                assert sorted(re.findall(r"-(cp\d+)-cp", " ".join(members))) == ["cp311", "cp313"]
        (target,) = [target for target in command.made() if target.name.replace("-", "_") in name]
        assert text == notes.text(target, packaging.version())


def test_zips_of_the_same_wheels_are_the_same(zips, tmp_path):
    again = make_zips(tmp_path)
    assert {name: path.read_bytes() for name, path in again.items()} == {
        name: path.read_bytes() for name, path in zips.items()
    }


@pytest.fixture(scope="module")
def examples(tmp_path_factory):
    """Return a file with meshes, and the results of this machine's module."""
    folder = tmp_path_factory.mktemp("examples")
    given = {
        "bumpy": meshes.bumpy_disk(2000, 2),
        "large": meshes.bumpy_disk(60000, 3),
        "rough": meshes.rough_grid(20, 0.7, 1),
    }
    arrays = {f"{name}_vertices": mesh[0] for name, mesh in given.items()}
    np.savez(folder / "meshes.npz", **arrays, **{f"{name}_triangles": mesh[1] for name, mesh in given.items()})
    call = [environment.PYTHON, EXAMPLES, folder / "meshes.npz", folder / "expected.npz"]
    subprocess.run(call, check=True, capture_output=True)
    return folder


def check_equal(found, examples):
    """Compare all results with those of this machine's own module."""
    with np.load(examples / "expected.npz") as expected, np.load(found) as results:
        assert sorted(results.files) == sorted(expected.files)
        for name in expected.files:
            np.testing.assert_allclose(results[name], expected[name], rtol=1e-9, atol=1e-9, err_msg=name)


def kernel_in(printed):
    """Return the kernels that OpenBLAS ran, from what EXAMPLES prints."""
    (kernel,) = re.findall(r"'kernel': '(.*?)'", printed)
    return kernel


def module_path(folder):
    """Return the environment of a Python on this machine that imports the module of an unpacked wheel."""
    return {**os.environ, "PYTHONPATH": str(folder)}


def test_linux_module_solves_as_the_one_built_here(unpacked, examples, tmp_path):
    target = target_or_skip("linux-x64")
    folder = unpacked(target, this_python())
    call = [environment.PYTHON, EXAMPLES, examples / "meshes.npz", tmp_path / "found.npz"]
    result = subprocess.run(call, env=module_path(folder), capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    assert str(folder / "spectral_conformal" / target.blas_name) in result.stdout
    assert processor.fits(kernel_in(result.stdout)), result.stdout
    check_equal(tmp_path / "found.npz", examples)


def this_python():
    """Return this Python's version, or skip the test when no wheels are made for it."""
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    if version not in targets.PYTHONS:
        pytest.skip(f"no wheels are made for Python {version}")
    return version


@pytest.mark.slow
def test_linux_module_passes_the_modules_tests(unpacked):
    folder = unpacked(target_or_skip("linux-x64"), this_python())
    call = [environment.PYTHON, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/module"]
    result = subprocess.run(call, cwd=ROOT, env=module_path(folder), capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout[-8000:]


@pytest.fixture(scope="module")
def linux_on_arm():
    target = target_or_skip("linux-arm64")
    if reason := qemu.obstacle():
        pytest.skip(f"not run: the module for Linux on ARM: {reason}")
    return target


@pytest.mark.slow
def test_arm_module_solves_as_the_one_built_here(linux_on_arm, unpacked, examples, tmp_path):
    folder = unpacked(linux_on_arm, qemu.VERSION)
    words = [EXAMPLES, examples / "meshes.npz", tmp_path / "found.npz"]
    result = qemu.run(words, environ={"PYTHONPATH": str(folder)}, timeout=1800)
    assert result.returncode == 0, result.stdout
    assert str(folder / "spectral_conformal" / linux_on_arm.blas_name) in result.stdout
    # The emulator's processor has NEON.
    assert not processor.is_below(kernel_in(result.stdout), {"asimd"}), result.stdout
    check_equal(tmp_path / "found.npz", examples)


# What test_memory.py limits is qemu's own address space, which is larger than that of the program that it runs. The
# slow tests would take another half hour.
NOT_UNDER_QEMU = ["--ignore=tests/module/test_memory.py", "-m", "not slow"]


@pytest.mark.slow
def test_arm_module_passes_the_modules_tests(linux_on_arm, unpacked):
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", *NOT_UNDER_QEMU, "tests/module"]
    environ = {"PYTHONPATH": str(unpacked(linux_on_arm, qemu.VERSION)), "PYTHONDONTWRITEBYTECODE": "1"}
    result = qemu.run(words, environ=environ, folder=ROOT, timeout=5400)
    assert result.returncode == 0, result.stdout[-8000:]


@pytest.fixture(scope="module")
def windows():
    target = target_or_skip("windows-x64")
    yield target
    wine.stop()


@pytest.fixture(scope="module")
def programs(windows):
    return native.build_tests(windows)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["spectral_conformal_tests", "spectral_conformal_thread_tests"])
def test_windows_runs_the_native_tests(programs, name):
    result = wine.run([programs / f"{name}.exe"], folder=programs, timeout=900)
    assert result.returncode == 0, result.stdout[-8000:]
    assert re.search(r"test cases: +[1-9]\d* \| +[1-9]\d* passed \| 0 failed", result.stdout), result.stdout[-1000:]


def windows_module(folder):
    """Return the environment of a Python for Windows that imports the module of an unpacked wheel."""
    return {"PYTHONPATH": wine.windows_path(folder), "PYTHONDONTWRITEBYTECODE": "1"}


@pytest.mark.slow
@pytest.mark.parametrize("python", wine.BPY)
def test_windows_module_solves_as_the_one_built_here(windows, python, unpacked, examples, tmp_path):
    folder = unpacked(windows, python)
    files = [wine.windows_path(path) for path in (EXAMPLES, examples / "meshes.npz", tmp_path / "found.npz")]
    result = wine.run([wine.python(python), *files], environ=windows_module(folder), timeout=900)
    assert result.returncode == 0, result.stdout
    assert windows.blas_name in result.stdout
    assert processor.fits(kernel_in(result.stdout)), result.stdout
    check_equal(tmp_path / "found.npz", examples)


@pytest.mark.slow
@pytest.mark.parametrize("python", wine.BPY)
def test_windows_module_passes_the_modules_tests(windows, python, unpacked):
    call = [wine.python(python), "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/module"]
    environ = windows_module(unpacked(windows, python))
    result = wine.run(call, environ=environ, folder=ROOT, timeout=1800)
    assert result.returncode == 0, result.stdout[-8000:]


GUARD = """
import ctypes, pathlib, threading
import numpy as np
import spectral_conformal as sc
package = pathlib.Path(sc.__file__).parent
blas = ctypes.CDLL(str(package / "spectral_conformal_openblas.dll"))
blas.openblas_set_num_threads(3)
with np.load(FILE) as meshes:
    mesh = meshes["bumpy_vertices"], meshes["bumpy_triangles"]
seen = set()
solver = sc.Solver(*mesh)
done = threading.Event()
def poll():
    while not done.is_set():
        seen.add(blas.openblas_get_num_threads())
thread = threading.Thread(target=poll)
thread.start()
for _ in range(20):
    sc.parameterize(*mesh)
done.set()
thread.join()
assert blas.openblas_get_num_threads() == 3, "the process's own number of threads is gone"
assert 1 in seen and seen <= {1, 3}, seen
"""


@pytest.mark.slow
def test_windows_module_fixes_the_number_of_blas_threads_and_puts_it_back(windows, unpacked, examples):
    python = targets.PYTHONS[-1]
    code = GUARD.replace("FILE", repr(wine.windows_path(examples / "meshes.npz")))
    result = wine.run([wine.python(python), "-c", code], environ=windows_module(unpacked(windows, python)))
    assert result.returncode == 0, result.stdout


@pytest.mark.slow
@pytest.mark.parametrize("python", wine.BPY)
def test_windows_extension_in_blender_for_windows(windows, python, zips, tmp_path):
    profile = tmp_path / "profile"
    profile.mkdir()
    package = zips[f"spectral_unwrap-{packaging.version()}-{windows.name.replace('-', '_')}.zip"]
    seen = tmp_path / "seen.json"
    words = [wine.windows_path(path) for path in (package, seen)]
    environ = {"BLENDER_USER_RESOURCES": wine.windows_path(profile)}
    program = wine.python(python, bpy=True)
    result = wine.run([program, wine.windows_path(SCRIPT), "--", *words], environ=environ, timeout=900)
    assert seen.is_file(), result.stdout[-8000:]
    observed = json.loads(seen.read_text())
    assert ".".join(map(str, observed["version"])) == wine.BPY[python]
    check_unwrapped(observed)
