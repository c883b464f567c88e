"""The model that a key of a scene belongs to, by its place."""

from typing import Any, get_args

from pydantic import BaseModel

from glrt.phong import Phong
from glrt.scene.animation.tracks import Animation, Track
from glrt.scene.camera import Camera
from glrt.scene.density import Density
from glrt.scene.lights.background import Background
from glrt.scene.lights.clear_sky import ClearSky
from glrt.scene.lights.cone import Cone
from glrt.scene.lights.sun import Sun
from glrt.scene.materials.kinds import TYPES
from glrt.scene.materials.textures import NormalTexture, Texture
from glrt.scene.medium import Medium
from glrt.scene.probes import Probes
from glrt.scene.schema.fields import SceneFields
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.transfer import Transfer
from glrt.settings import RenderSettings

TABLES: dict[str, type[BaseModel]] = {
    "camera": Camera,
    "render": RenderSettings,
    "render.phong": Phong,
    "background": Background,
    "background.sky": ClearSky,
    "sun": Sun,
    "probes": Probes,
    "animation": Animation,
    "media": Medium,
}
_Nested = tuple[int, str, type[BaseModel]]  # of a table in a table: how deep, its key, its model
_NESTED: dict[str, tuple[_Nested, ...]] = {
    "media": ((2, "density", Density), (2, "transfer", Transfer)),
    "materials": ((3, "cone", Cone),),
}
_TRACK = 3  # keys down to a track: a longer location is of a key of it
KINDS_OF: dict[str, dict[str, Any]] = {"materials": TYPES, "objects": KINDS}


def model_of(location: tuple[int | str, ...]) -> type[BaseModel]:
    """Return the model that a key belongs to, by the location that pydantic gives it."""
    table = str(location[0])
    if len(location) == 1:
        return SceneFields
    if location[:2] == ("animation", "tracks") and len(location) > _TRACK:
        return Track
    for depth, key, inner in _NESTED.get(table, ()):
        if location[depth:-1] == (key,):
            return inner
    if table not in KINDS_OF:
        inner_table = ".".join(map(str, location[:2]))
        return TABLES.get(inner_table if len(location) > 2 else table, TABLES[table])
    if len(location) > 4 and str(location[3]).endswith(("_map", "normal")):
        return NormalTexture if location[3] == "normal" else Texture
    model: type[BaseModel] = KINDS_OF[table][str(location[2])]
    return model


def is_of_any_length(location: tuple[int | str, ...]) -> bool:
    """Return whether a key takes a list of any length, as knots and tracks do."""
    field = model_of(location).model_fields.get(str(location[-1]))
    return field is not None and get_args(field.annotation)[-1:] == (...,)
