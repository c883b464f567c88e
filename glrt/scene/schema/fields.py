"""The fields of a scene, each with its range and meaning."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, field_validator, model_validator

from glrt.scene.animation.tracks import Animation
from glrt.scene.camera import Camera
from glrt.scene.lights.background import Background
from glrt.scene.lights.sun import Sun
from glrt.scene.materials.kinds import Material
from glrt.scene.medium import Medium
from glrt.scene.probes import Probes
from glrt.scene.shapes.kinds import Shape
from glrt.scene.values import Intensity, Name
from glrt.settings import Cost, Editable, Frozen, RenderSettings

MAX_OBJECTS = 65_536
MAX_MEDIA = 8
NONE = "none"  # the name and the type of a material that is no surface


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
    media: Annotated[dict[Name, Medium], Field(max_length=MAX_MEDIA)] = Field(
        {}, description="media by name, at most 8: what fills objects or all of space"
    )
    medium: Name | None = Field(
        None,
        description="name of the medium around all objects; default: vacuum",
    )
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

    @model_validator(mode="before")
    @classmethod
    def _knows_none(cls, data: Any) -> Any:
        """Add the material `none` where objects have it, and the scene has none of that name."""
        if not isinstance(data, Mapping) or not isinstance(data.get("objects"), list | tuple):
            return data
        materials = data.get("materials", {})
        is_known = not isinstance(materials, Mapping) or NONE in materials
        if is_known or all(_material(thing) != NONE for thing in data["objects"]):
            return data
        return {**data, "materials": {**materials, NONE: {"type": NONE}}}

    @field_validator("format")
    @classmethod
    def _is_known_format(cls, value: int) -> int:
        if value != 1:
            raise ValueError("must be 1, the only format that this version of glrt reads")
        return value


def _material(thing: Any) -> Any:
    return thing.get("material") if isinstance(thing, Mapping) else getattr(thing, "material", None)
