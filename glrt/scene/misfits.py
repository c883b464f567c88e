"""Parts of a scene that are valid, but do not go together."""

from collections.abc import Iterator

from glrt.core.text import unknown
from glrt.scene.loading.mesh_parts import lacks_material
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import glass_of
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.validation import Place


def object_problems(scene: SceneFields) -> Iterator[tuple[Place, str]]:
    """Yield place and advice for objects that do not go with their material."""
    missing: set[str] = set()
    for index, item in enumerate(scene.objects):
        if lacks_material(item):
            continue  # its file has materials
        material = scene.materials.get(item.material)
        if material is None and item.material not in missing:
            missing.add(item.material)  # reported once, where it is used first
            advice = unknown("material", item.material, sorted(scene.materials))
            yield ("objects", index, "material"), advice
        if not item.has_coordinates and isinstance(material, Opaque) and material.textures:
            yield ("objects", index, "material"), _TEXTURE_ADVICE.format(item.shape)
        glass = glass_of(material)
        if glass and not (item.encloses or glass.thin):
            article = "an open" if item.has_inside else "a"
            yield ("objects", index), _GLASS_ADVICE.format(f"{article} {item.shape}")


def sun_problems(scene: SceneFields) -> Iterator[tuple[Place, str]]:
    """Yield place and advice for a sun and a sky that do not go together."""
    sun, sky = scene.sun, scene.background.sky
    if sky and not sun:
        yield ("background", "sky"), "needs [sun], which says where the sun stands"
    if sky and sun and sun.towards[1] < 0:
        place = "direction" if sun.elevation is None else "elevation"
        yield ("sun", place), "is below the horizon; background.sky is a sky of the day"
    if sun and sun.irradiance is None and not sky:
        yield ("sun", "irradiance"), "is missing; give it, or a background with sky"


_GLASS_ADVICE = (
    "{} encloses nothing, so it cannot be dielectric; use a sphere, a plane, a box, a "
    "cylinder with caps or a closed mesh, or a material with thin = true"
)
_TEXTURE_ADVICE = (
    "has a texture, and a {} has no texture coordinates; use a mesh of its form, or a material "
    "without textures"
)
