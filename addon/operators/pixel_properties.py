# SPDX-License-Identifier: GPL-3.0-or-later
"""The margin and the size of the texture as properties of operators that pack."""

import bpy
from bpy.props import FloatProperty, IntProperty

from .. import names
from ..core.words import texts
from ..edit_mesh import texture_size


class PixelProperties:
    """A margin in pixels, and the side of the texture that it counts in; not kept, because the scene has them."""

    margin: FloatProperty(**texture_size.MARGIN, options={"SKIP_SAVE"})
    texture_size: IntProperty(
        **texts.TEXTURE_OF_CALL_PROPERTY, default=0, min=0, max=65536, soft_max=8192, options={"SKIP_SAVE"}
    )

    def pixels(self, context: bpy.types.Context) -> tuple[float, float]:
        """Return the margin, that of the scene unless one is given, and the side of the texture."""
        if not self.properties.is_property_set("margin"):
            self.margin = getattr(context.scene, names.MARGIN_PROPERTY)
        return self.margin, self.texture_size or texture_size.side(context)
