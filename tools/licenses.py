# SPDX-License-Identifier: GPL-3.0-or-later
"""The license texts of third-party code in a wheel, from the packages of that code."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from tools.steps import StepError

DEBIAN_COPYRIGHT = Path("/usr/share/doc")
DEBIAN_LICENSES = Path("/usr/share/common-licenses")


def of_debian(package: str) -> Path:
    """Return the license file of a system package."""
    return DEBIAN_COPYRIGHT / package / "copyright"


def of_pip(folder: Path, package: str) -> Path:
    """Return the license file of a package that pip installed into a folder."""
    found = sorted(folder.glob(f"{package}-*.dist-info/licenses/LICENSE*"))
    return found[0] if found else folder / f"{package}-*.dist-info/licenses/LICENSE"


def of_headers() -> dict[str, Path]:
    """Return the license files of the compiled-in system headers, by name, and the long texts that they name."""
    return {
        "cgal": of_debian("libcgal-dev"),
        "eigen": of_debian("libeigen3-dev"),
        **{f"text-of-{name.lower()}": DEBIAN_LICENSES / name for name in ("Apache-2.0", "LGPL-2.1", "MPL-2.0")},
    }


def texts(files: Mapping[str, Path]) -> dict[str, bytes]:
    """Read these files, named without suffix, and Boost's license; return them by file name."""
    if missing := [str(path) for path in files.values() if not path.is_file()]:
        raise StepError(f"License texts for the wheel are missing: {', '.join(missing)}")
    return {**{f"{name}.txt": path.read_bytes() for name, path in sorted(files.items())}, "boost.txt": boost_license()}


def boost_license() -> bytes:
    """Return Boost's license; Debian's list of all its authors has 2 MB."""
    (path,) = sorted(DEBIAN_COPYRIGHT.glob("libboost1.*-dev/copyright"))[:1]
    found = re.search(r"Boost Software License - Version 1\.0 - August.*(?:\n .*)+", path.read_text())
    if not found:
        raise StepError(f"{path} does not contain the Boost Software License.")
    return re.sub(r"\n (\.$)?", "\n", found[0], flags=re.MULTILINE).encode() + b"\n"
