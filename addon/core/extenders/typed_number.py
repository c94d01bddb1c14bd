# SPDX-License-Identifier: GPL-3.0-or-later
"""A number typed while the mouse drags, as Blender's own transforms take it."""


class TypedNumber:
    """Collects the characters of a number.

    Attributes:
        text: what has been typed; empty while nothing was.
    """

    def __init__(self) -> None:
        """Start without a number."""
        self.text = ""

    @property
    def value(self) -> float | None:
        """The number, None while nothing or only a sign or a point was typed."""
        try:
            return float(self.text)
        except ValueError:
            return None

    def type(self, character: str) -> bool:
        """Take a digit, a point, or a minus, which changes the sign wherever it comes; return whether it was one."""
        character = "." if character == "," else character
        if character == "-":
            self.text = self.text[1:] if self.text.startswith("-") else "-" + self.text
        elif character.isdecimal() and character.isascii() or (character == "." and "." not in self.text):
            self.text += character
        else:
            return False
        return True

    def erase(self) -> None:
        """Take the last character back."""
        self.text = self.text[:-1]
