"""What image nodes of a .blend or .fbx file are for, so that assets of an atlas can share one image for each role."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..._rebaking import Content
from ...assets.shared_textures import BASE_COLOR, EMISSIVE, METALLIC, METALLIC_ROUGHNESS, NORMAL, ROUGHNESS

_SRGB = "sRGB"
_PRINCIPLED = "BSDF_PRINCIPLED"
# By the inputs of the Principled BSDF that an image feeds; the emission has another name before 4.0.
_ROLES: dict[frozenset[str], tuple[str, Content]] = {
    frozenset(["Base Color"]): (BASE_COLOR, "color"),
    frozenset(["Emission"]): (EMISSIVE, "color"),
    frozenset(["Emission Color"]): (EMISSIVE, "color"),
    frozenset(["Roughness"]): (ROUGHNESS, "data"),
    frozenset(["Metallic"]): (METALLIC, "data"),
    frozenset(["Roughness", "Metallic"]): (METALLIC_ROUGHNESS, "data"),
    frozenset(["Normal"]): (NORMAL, "normals"),
}


def role_of(node: bpy.types.Node, content: Content) -> str:
    """Return the role of a node's image, empty if it has none or codes its values otherwise than other formats do."""
    fed = frozenset(_fed(node.outputs["Color"], set()))
    role, expected = _ROLES.get(fed, ("", content))
    space = node.image.colorspace_settings
    is_coded_alike = content == expected and (space.name == _SRGB if content == "color" else space.is_data)
    has_other_use = role != BASE_COLOR and node.outputs["Alpha"].is_linked
    return role if is_coded_alike and not has_other_use and not node.image.is_float else ""


def _fed(output: bpy.types.NodeSocket, seen: set[str]) -> Iterator[str]:
    """Yield the inputs of Principled BSDFs that an output feeds through other nodes, and the types of other shaders."""
    for link in output.links:
        node = link.to_node
        if node.type == _PRINCIPLED:
            yield link.to_socket.name
        elif node.type in ("GROUP", "OUTPUT_MATERIAL") or any(each.type == "SHADER" for each in node.outputs):
            yield node.type
        elif node.name not in seen:
            seen.add(node.name)
            for each in node.outputs:
                yield from _fed(each, seen)
