"""The fields of a scene, each with its range and meaning."""

from typing import Annotated

from pydantic import Field, field_validator

from glrt.scene.animation.tracks import Animation
from glrt.scene.camera import Camera
from glrt.scene.lights.background import Background
from glrt.scene.lights.sun import Sun
from glrt.scene.materials.kinds import Material
from glrt.scene.probes import Probes
from glrt.scene.shapes.kinds import Shape
from glrt.scene.values import Intensity, Name
from glrt.settings import Cost, Editable, Frozen, RenderSettings

MAX_OBJECTS = 65_536


class SceneFields(Frozen):
    """The fields of a scene; `Scene` checks whether they fit together."""

    title: Annotated[str, Field(pattern=r"^[^\x00-\x1f\x7f]*$")] | None = Field(
        None, description="one sentence on one line, shown in the gallery"
    )
    format: int = Field(
        1, description="version of the scene format: 1", json_schema_extra={"const": 1}
    )
    camera: Camera = Field(description="the camera")
    render: RenderSettings = Field(RenderSettings(), description="default settings of the scene")
    background: Background = Field(
        Background(), description="light from infinitely far away; its light group is `background`"
    )
    sun: Sun | None = Field(
        None, description="a disc at infinity; its light group is `sun`; default: there is none"
    )
    probes: Probes | None = Field(
        None,
        description="the box that methods ddgi, gather and resampled put their probes into; "
        "default: around what is seen",
    )
    materials: dict[Name, Material] = Field({}, description="materials by name")
    lights: Annotated[dict[Name, Intensity], Editable(Cost.RELIGHT, "", (0, 10))] = Field(
        {},
        description="intensity of each light group, a factor from 0 to 1e15; default: 1",
    )
    objects: tuple[Shape, ...] = Field(
        (), max_length=MAX_OBJECTS, description="the shapes, at most 65,536"
    )

    animation: Animation | None = Field(
        None, description="values that change from frame to frame; default: a still"
    )

    @field_validator("format")
    @classmethod
    def _is_known_format(cls, value: int) -> int:
        if value != 1:
            raise ValueError("must be 1, the only format that this version of glrt reads")
        return value
