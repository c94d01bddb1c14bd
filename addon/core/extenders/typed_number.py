# SPDX-License-Identifier: GPL-3.0-or-later
"""A number typed while dragging, as in Blender's own transforms."""


class TypedNumber:
    """Collects the characters of a number.

    Attributes:
        text: what has been typed so far.
    """

    def __init__(self) -> None:
        """Start without a number."""
        self.text = ""

    @property
    def value(self) -> float | None:
        """The number; None while there is only a sign or a point."""
        try:
            return float(self.text)
        except ValueError:
            return None

    def type(self, character: str) -> bool:
        """Add a digit or a point, or change the sign with a minus; return whether it was one of these."""
        character = "." if character == "," else character
        if character == "-":
            self.text = self.text[1:] if self.text.startswith("-") else "-" + self.text
        elif character.isdecimal() and character.isascii() or (character == "." and "." not in self.text):
            self.text += character
        else:
            return False
        return True

    def erase(self) -> None:
        """Remove the last character."""
        self.text = self.text[:-1]
