# SPDX-License-Identifier: GPL-3.0-or-later
"""The compilers by target, as CMake toolchain files: MinGW for Windows, zig for the rest, LLVM's linker for macOS."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

from tools import steps
from tools.cross import parts
from tools.cross.targets import CROSS, MACOS_MINIMUM, PYTHONS, Target
from tools.environment import PYTHON, VENV, site_packages
from tools.steps import ROOT, StepError
from tools.wheels import python_tag

ZIG = site_packages(VENV) / "ziglang" / "zig"
ZIG_CACHE = CROSS / "zig-cache"
LINKER_OF_MACOS = "ld64.lld-19"
# The SDK that a macOS bundle names; none is needed.
MACOS_SDK = "15.1"
# Binaries contain no path of this machine.
COMMON_FLAGS = f"-ffile-prefix-map={ROOT}=."
# Boost 1.74 uses features that C++17 deprecated and LLVM's library hides.
ZIG_DEFINITION = "-D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION"
LOG = "cross-build"
# Symbols of the C++ library in the module must not mix with those of Blender.
LINUX_EXPORTS = "{ global: PyInit__native; local: *; };\n"


def toolchain(target: Target) -> Path:
    """Write a target's toolchain file for CMake and return it."""
    folder = target.folder / "toolchain"
    folder.mkdir(parents=True, exist_ok=True)
    settings = {
        "CMAKE_SYSTEM_NAME": target.system,
        "CMAKE_SYSTEM_PROCESSOR": target.processor,
        "CMAKE_C_FLAGS_INIT": COMMON_FLAGS,
        "CMAKE_CXX_FLAGS_INIT": COMMON_FLAGS,
        "CMAKE_INTERPROCEDURAL_OPTIMIZATION": "OFF",
        # All libraries and header folders are given explicitly.
        "CMAKE_FIND_USE_CMAKE_SYSTEM_PATH": "OFF",
        "CMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH": "OFF",
        **(mingw(target) if target.system == "Windows" else zig(target, folder)),
    }
    if target.system == "Darwin":
        settings |= macos(target, folder)
    elif target.system == "Linux":
        exports = folder / "exports.map"
        write(exports, LINUX_EXPORTS)
        settings["CMAKE_MODULE_LINKER_FLAGS_INIT"] = f"-s -Wl,--version-script={exports}"
        # Beside the module, not in the folder of OpenBLAS at link time.
        settings |= {"CMAKE_BUILD_WITH_INSTALL_RPATH": "ON", "CMAKE_INSTALL_RPATH": "$ORIGIN"}
    path = folder / "toolchain.cmake"
    text = "".join(f"set({name} [==[{value}]==])\n" for name, value in settings.items())
    if path.is_file() and path.read_text() != text:
        # CMake reads these settings once for a build folder.
        for built in {"cholmod", "libraries", "tests", *map(python_tag, PYTHONS)}:
            shutil.rmtree(target.folder / built, ignore_errors=True)
    write(path, text)
    return path


def mingw(target: Target) -> dict[str, str]:
    """Return the settings for MinGW, which links its libraries statically, so that Windows needs none of them."""
    flags = "-static -static-libgcc -static-libstdc++ -Wl,--no-insert-timestamp"
    return {
        "CMAKE_C_COMPILER": program(f"{target.triple}-gcc-posix"),
        "CMAKE_CXX_COMPILER": program(f"{target.triple}-g++-posix"),
        "CMAKE_RC_COMPILER": program(f"{target.triple}-windres"),
        "CMAKE_EXE_LINKER_FLAGS_INIT": flags,
        "CMAKE_MODULE_LINKER_FLAGS_INIT": f"{flags} -s",
        # The linker omits the symbols; strip would add the current time.
        "CMAKE_STRIP": "/bin/true",
    }


def zig(target: Target, folder: Path) -> dict[str, str]:
    """Return the settings for zig, which compiles with clang for any system and includes the headers."""
    compile_for = f"-target {target.triple}"
    commands = {"cc": compile_for, "c++": f"{compile_for} {ZIG_DEFINITION}", "ar": "", "ranlib": ""}
    for name, words in commands.items():
        path = folder / name
        cache = f"export ZIG_GLOBAL_CACHE_DIR='{ZIG_CACHE}' ZIG_LOCAL_CACHE_DIR='{ZIG_CACHE}'"
        write(path, f"#!/bin/sh\n{cache}\nexec '{ZIG}' {name} {words} \"$@\"\n")
        path.chmod(0o755)
    return {
        "CMAKE_C_COMPILER": f"{folder / 'cc'}",
        "CMAKE_CXX_COMPILER": f"{folder / 'c++'}",
        "CMAKE_AR": f"{folder / 'ar'}",
        "CMAKE_RANLIB": f"{folder / 'ranlib'}",
        "CMAKE_STRIP": "/bin/true",
        # Our linker cannot link a program for macOS.
        "CMAKE_TRY_COMPILE_TARGET_TYPE": "STATIC_LIBRARY",
    }


def macos(target: Target, folder: Path) -> dict[str, str]:
    """Return the settings that link modules with LLVM's linker, since zig's own writes damaged bundles."""
    words = [
        program(LINKER_OF_MACOS),
        f"-bundle -arch {target.processor} -platform_version macos {MACOS_MINIMUM} {MACOS_SDK}",
        # Python's functions come from the process that loads the module.
        "-undefined dynamic_lookup -exported_symbol _PyInit__native -dead_strip -x -S",
        "-o <TARGET> <OBJECTS> <LINK_LIBRARIES>",
        *(str(path) for path in macos_libraries(target)),
    ]
    # A toolchain file cannot replace CMake's rule for modules, because CMake reads the rules for macOS after it.
    rules = folder / "rules.cmake"
    write(rules, f"set(CMAKE_CXX_CREATE_SHARED_MODULE [==[{' '.join(words)}]==])\n")
    return {
        "CMAKE_INSTALL_NAME_TOOL": "/bin/true",
        "CMAKE_OSX_DEPLOYMENT_TARGET": MACOS_MINIMUM,
        "CMAKE_OSX_SYSROOT": "",
        "CMAKE_USER_MAKE_RULES_OVERRIDE_CXX": str(rules),
    }


def macos_libraries(target: Target) -> list[Path]:
    """Return the C++ library and the compiler's library, which zig builds once, and the symbols of macOS's own."""
    cache = target.folder / "runtime"
    names = ("libc++.a", "libc++abi.a", "libcompiler_rt.a")
    state = steps.digest(["0.14.1", target.triple])
    if not steps.is_done(f"cross-runtime-{target.name}", state) or not cache.is_dir():
        shutil.rmtree(cache, ignore_errors=True)
        cache.mkdir(parents=True)
        source = cache / "any.cpp"
        source.write_text("#include <string>\nstd::string any() { return std::to_string(1.5); }\n")
        command = [ZIG, "c++", "-target", target.triple, "-O3", "-shared", source, "-o", cache / "any.dylib"]
        caches = {"ZIG_GLOBAL_CACHE_DIR": str(cache), "ZIG_LOCAL_CACHE_DIR": str(cache)}
        steps.run(f"building C++'s library for {target.name} (zig)", command, log=LOG, environ=caches)
        steps.mark_done(f"cross-runtime-{target.name}", state)
    found = {path.name: path for path in cache.rglob("*.a")}
    if missing := [name for name in names if name not in found]:
        raise StepError(f"zig left no {', '.join(missing)} in {cache}.")
    return [*(found[name] for name in names), ZIG.parent / "lib" / "libc" / "darwin" / "libSystem.tbd"]


def program(name: str) -> str:
    """Return the path of an installed program."""
    found = shutil.which(name)
    if not found:
        raise StepError(f"{name} is not installed.")
    return found


def write(path: Path, text: str) -> None:
    """Write a file unless it has this text: CMake reconfigures if a file is newer than its cache."""
    if not path.is_file() or path.read_text() != text:
        path.write_text(text)


def configure_and_build(
    title: str, source: Path, build: Path, settings: Mapping[str, object], targets: tuple[str, ...], jobs: int
) -> None:
    """Run CMake for a folder of sources and build some of its targets."""
    cmake = PYTHON.parent / "cmake"
    definitions = [f"-D{name}={value}" for name, value in settings.items()]
    generator = ["-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={PYTHON.parent / 'ninja'}"]
    steps.run(f"configuring {title}", [cmake, "-S", source, "-B", build, *generator, *definitions], log=LOG)
    command = [cmake, "--build", build, "--parallel", jobs, "--target", *targets]
    steps.run(f"building {title} ({jobs} at a time)", command, log=LOG)


def part_settings(target: Target) -> dict[str, object]:
    """Return CMake's settings for the parts that all builds of a target share."""
    headers = parts.headers()
    return {
        "CMAKE_TOOLCHAIN_FILE": toolchain(target),
        "CMAKE_BUILD_TYPE": "Release",
        # Most of the time goes into Eigen's headers.
        "CMAKE_UNITY_BUILD": "ON",
        "CMAKE_UNITY_BUILD_BATCH_SIZE": 8,
        "BOOST_INCLUDE_DIR": headers,
        "CGAL_INCLUDE_DIR": headers,
        "DOCTEST_INCLUDE_DIR": headers,
        "SPECTRA_INCLUDE_DIR": headers,
        "Eigen3_DIR": "/usr/share/eigen3/cmake",
        "pybind11_DIR": parts.pybind11(),
    }
