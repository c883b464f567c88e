"""Parts that a scene can do without: objects, lights, textures and features of materials."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from glrt.core.errors import SceneError
from glrt.core.text import shortened
from glrt.rendering.paths.records import object_name
from glrt.scene.lights.background import Background
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.textures import Texture
from glrt.scene.scene import Scene
from glrt.scene.schema.validation import validated
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import BLACK

# Keys of materials without which a kernel has less to do, and their value then.
FEATURES: Mapping[str, Any] = {
    "normal": None,
    "clearcoat": 0.0,
    "anisotropy": 0.0,
    "iridescence": 0.0,
    "sheen": BLACK,
    "diffuse_transmission": 0.0,
    "dispersion": 0.0,
    "transmission": 0.0,
    "roughness": 0.0,
    "metallic": 0.0,
    "specular": 0.0,
    "alpha": 1.0,
    "cone": None,
}
ATTENUATION = {"attenuation_color": None, "attenuation_distance": None}


@dataclass(frozen=True)
class Part:
    """A part of a scene, and the values that its owner has without it."""

    name: str  # in words, such as "object ball"
    table: str  # of the scene: objects, materials, camera, background, sun or medium
    owner: int | str | None = None  # number of an object, name of a material
    values: tuple[tuple[str, Any], ...] | None = None  # None: the owner goes


def objects_of(scene: Scene) -> list[Part]:
    """Return the objects, lamps among them, in the order of the scene."""
    return [Part(_told(scene, n), "objects", n) for n in range(len(scene.objects))]


def _told(scene: Scene, number: int) -> str:
    thing, name = scene.objects[number], shortened(object_name(scene, number))
    kind = "lamp " if is_lamp(scene, number) else "object " if thing.name else ""
    return f"{kind}{name}"


def is_lamp(scene: Scene, number: int) -> bool:
    """Whether an object emits light."""
    return any(scene.emission_of(scene.objects[number]))


def features_of(scene: Scene) -> list[Part]:
    """Return lights without a surface, the lens, media, textures and features of materials."""
    return [*_lights(scene), *_surfaces(scene)]


def _lights(scene: Scene) -> Iterator[Part]:
    if scene.sun:
        yield Part("the sun", "sun")
    if any(map(any, scene.background_colors)):
        yield Part("the background", "background")
    if scene.camera.defocus_angle > 0:
        yield Part("the lens", "camera", None, (("defocus_angle", 0.0),))
    if scene.medium:
        yield Part(f"the medium {shortened(scene.medium)} around all objects", "medium")


def _surfaces(scene: Scene) -> Iterator[Part]:
    for name, material in scene.materials.items():
        textures = material.textures if isinstance(material, Opaque) else {}
        for key, texture in textures.items():
            if key != "normal":
                yield _texture(name, key, material, texture)
        for key, plain in FEATURES.items():
            is_texture = key in textures and key != "normal"
            if not is_texture and getattr(material, key, plain) != plain:
                yield Part(f"{key} of {shortened(name)}", "materials", name, ((key, plain),))
        if getattr(material, "attenuation_color", None) is not None:
            told = f"attenuation of {shortened(name)}"
            yield Part(told, "materials", name, tuple(ATTENUATION.items()))
    for number, thing in enumerate(scene.objects):
        name = shortened(object_name(scene, number))
        if thing.medium:
            yield Part(f"medium of {name}", "objects", number, (("medium", None),))
        if isinstance(thing, Mesh) and thing.smooth is not False:
            yield Part(f"smooth normals of {name}", "objects", number, (("smooth", False),))


def _texture(name: str, key: str, material: Material, texture: Texture) -> Part:
    """Return a texture, in whose place its mean stands, times its factor."""
    factor = getattr(material, key)
    mean = _mean(texture, isinstance(factor, tuple))
    values = {key: _times(factor, mean), f"{key}_map": None}
    return Part(f"texture {key} of {shortened(name)}", "materials", name, tuple(values.items()))


def _mean(texture: Texture, is_color: bool) -> tuple[float, ...]:
    means = texture.texels.astype(float).mean(axis=(0, 1)).tolist()
    if texture.channel:
        return (means["rgba".index(texture.channel)],) * 3
    return tuple(means[:3]) if is_color else (means[0],) * 3


def _times(factor: Any, mean: tuple[float, ...]) -> Any:
    if isinstance(factor, tuple):
        return tuple(a * b for a, b in zip(factor, mean, strict=True))
    return factor * mean[0]


def without(scene: Scene, parts: Collection[Part]) -> Scene | None:
    """Return the scene without parts, and without what only they used; None if it cannot be."""
    going = {part.owner for part in parts if part.table == "objects" and part.values is None}
    tables: dict[str, Any] = {"objects": list(scene.objects), "materials": {**scene.materials}}
    try:
        for part in parts:
            _apply(scene, tables, part)
        kept = [thing for n, thing in enumerate(tables["objects"]) if n not in going]
        tables["objects"] = tuple(kept)
        used = {thing.material for thing in kept}
        tables["materials"] = {n: it for n, it in tables["materials"].items() if n in used}
        media = {tables.get("medium", scene.medium), *(thing.medium for thing in kept)}
        tables["media"] = {name: it for name, it in scene.media.items() if name in media}
        smaller = scene.model_copy(update={**tables, "lights": {}})
        groups = {*smaller.light_groups, *(thing.group for thing in kept)}
        tables["lights"] = {name: it for name, it in scene.lights.items() if name in groups}
        return validated(type(scene), dict(scene) | tables, "")
    except SceneError:
        return None


def _apply(scene: Scene, tables: dict[str, Any], part: Part) -> None:
    if part.values is None:
        nothing = {"sun": None, "background": Background(), "medium": None}
        if part.table in nothing:
            tables[part.table] = nothing[part.table]
        return
    whole = tables.get(part.table, getattr(scene, part.table))
    owner: Any = whole if part.owner is None else whole[part.owner]
    fields = {**dict(owner), **dict(part.values)}
    new = validated(type(owner), {n: v for n, v in fields.items() if v is not None}, "")
    if part.owner is None:
        tables[part.table] = new
    else:
        whole[part.owner] = new
