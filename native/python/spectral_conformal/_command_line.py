"""Option records on the command line: each field becomes an option with its documentation."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable
from dataclasses import fields
from typing import Any

from . import _native
from ._options import _CHOICES, documented


def add_version(parser: argparse.ArgumentParser) -> None:
    """Add --version."""
    parser.add_argument("--version", action="version", version=f"spectral_conformal {_native.VERSION}")


def said(error: Exception) -> str:
    """Return the message of an error, that of the system with the file and without its number."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror.lower()}." if error.filename is not None else f"{error.strerror}."
    return str(error)


def add_fields(
    group: Any,  # noqa: ANN401 - argparse keeps the name of its groups to itself
    record: Any,  # noqa: ANN401 - any dataclass whose docstring lists its attributes
    left_out: Iterable[str] = (),
    prefix: str = "",
) -> list[str]:
    """Add an option for every field of a record, with dashes for underscores; return the fields' names.

    The parsed arguments contain only the options that were given. Values of fields that are neither flags nor choices
    are numbers, or words that the record accepts or rejects.

    Args:
        group: a group of an `argparse.ArgumentParser`, or the parser itself.
        record: with the defaults; its docstring documents the fields.
        left_out: names of fields that do not become options.
        prefix: of the names in the parsed arguments.
    """
    documentation, names = documented(type(record)), []
    for field in fields(record):
        if field.name in left_out:
            continue
        names.append(field.name)
        default = getattr(record, field.name)
        text = re.sub(r"\s+", " ", documentation.get(field.name, "").partition(":")[2]).strip().replace("%", "%%")
        # The usage shows the type.
        text = text.removeprefix("bool, ").removeprefix("(3,) ")
        shown = "" if default in (None, "") else f" ({default})"
        how: dict[str, object] = {"help": text + shown, "default": argparse.SUPPRESS, "dest": prefix + field.name}
        if str(field.type).startswith("bool"):
            how["action"] = argparse.BooleanOptionalAction
        else:
            if field.name in _CHOICES:
                how["choices"] = _CHOICES[field.name]
            else:
                how["type"], how["metavar"] = number_or_word, "X"
            if "without_value" in field.metadata:
                how["nargs"], how["const"] = "?", field.metadata["without_value"]
            if field.name == "front":
                how["nargs"], how["metavar"] = 3, ("X", "Y", "Z")
        group.add_argument(f"--{field.name.replace('_', '-')}", **how)
    return names


def number_or_word(text: str) -> float | str:
    """Return an int or a float if the text is one, otherwise the text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
