"""Every kind of shape, in the order of the kernel's numbering.

Each is a frozen model with its geometry for the host, in a file of its own. The kernel's part of a
shape is in shaders_glsl/shapes/ and glrt/packing/shapes.py. docs/extending.md explains how to add a
kind.
"""

from inspect import isabstract
from typing import Annotated, Any, get_args

from pydantic import Field

from glrt.scene.shapes.base import Object
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

Shape = Annotated[
    Sphere | Plane | Quad | Disk | Box | Cylinder | Mesh, Field(discriminator="shape")
]

KINDS: dict[str, Any] = {  # the model of each kind, in the order of the kernel's numbering
    kind.model_fields["shape"].default: kind for kind in get_args(get_args(Shape)[0])
}

SAMPLED = tuple(  # kinds of lamps that are sampled and send particles; triangles are, one by one
    name for name, kind in KINDS.items() if kind is Mesh or kind.lamp_body is not Object.lamp_body
)

for _kind in KINDS.values():
    if isabstract(_kind):
        raise TypeError(f"{_kind.__name__} lacks {', '.join(sorted(_kind.__abstractmethods__))}")
