"""Parts of a scene that are valid, but do not go together."""

from collections.abc import Iterator

from glrt.core.text import unknown
from glrt.scene.loading.mesh_parts import lacks_material
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.nothing import Nothing
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.validation import Place
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.volumes import has_ranks


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
        if isinstance(item, Mesh) and item.hides_backs and _bounds(item, material):
            yield ("objects", index, "backfaces"), _BACKS_ADVICE.format(item.material)
        glass = glass_of(material)
        if glass and not (item.encloses or glass.thin):
            article = "an open" if item.has_inside else "a"
            yield ("objects", index), _GLASS_ADVICE.format(f"{article} {item.shape}")


def _bounds(mesh: Mesh, material: Material | None) -> bool:
    """Return whether light that enters a mesh must leave it through its backs."""
    is_volume = isinstance(material, Nothing) or mesh.medium is not None
    return is_volume or glass_of(material) is not None


def medium_problems(scene: SceneFields) -> Iterator[tuple[Place, str]]:
    """Yield place and advice for media that do not go with the objects that hold them."""
    if scene.medium is not None:
        yield from _medium_problem(scene, ("medium",), scene.medium, is_endless=True)
    if has_ranks(scene):
        for name in dict.fromkeys(item.material for item in scene.objects):
            glass = glass_of(scene.materials.get(name))
            if glass and glass.priority is not None and glass.roughness > 0:
                yield ("materials", name, "priority"), _ROUGH_PRIORITY_ADVICE
    for index, item in enumerate(scene.objects):
        material = scene.materials.get(item.material)
        if isinstance(material, Nothing) and not item.encloses:
            yield ("objects", index, "material"), _OPEN_ADVICE.format(item.shape)
        if item.priority is not None and material is not None and not _is_entered(material):
            yield ("objects", index, "priority"), _PRIORITY_ADVICE
        if item.medium is None:
            continue
        place = ("objects", index, "medium")
        yield from _medium_problem(scene, place, item.medium, is_endless=item.shape == "plane")
        if material is not None and not isinstance(material, Nothing):
            if not isinstance(material, Dielectric) or material.thin:
                yield place, _SURFACE_ADVICE
            elif any(material.absorption):
                yield place, _TINTED_ADVICE
            elif material.roughness > 0:
                yield place, _ROUGH_ADVICE


def _is_entered(material: Material) -> bool:
    """Return whether light enters an object of this material, so that it holds a volume."""
    glass = glass_of(material)
    return isinstance(material, Nothing) or (glass is not None and not glass.thin)


def _medium_problem(
    scene: SceneFields, place: Place, name: str, is_endless: bool
) -> Iterator[tuple[Place, str]]:
    medium = scene.media.get(name)
    if medium is None:
        yield place, unknown("medium", name, sorted(scene.media))
    elif is_endless and any(
        e and not x for e, x in zip(medium.emission, medium.extinction, strict=True)
    ):
        yield ("media", name, "emission"), _ENDLESS_ADVICE


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


_BACKS_ADVICE = (
    "hidden does not go with glass, a medium or the type none, which light leaves through the "
    "backs of triangles; leave it out, or give the object another material than {!r}"
)
_OPEN_ADVICE = (
    "is of type none, which bounds a volume, and this {} encloses none; use a sphere, a plane, a "
    "box, a cylinder with caps or a closed mesh"
)
_PRIORITY_ADVICE = (
    "light does not enter this object, so it holds no volume; leave the priority out, or give the "
    "object the material none or glass"
)
_SURFACE_ADVICE = (
    "light does not enter this object; give it the material none, or smooth glass that encloses it"
)
_TINTED_ADVICE = (
    "the glass absorbs light by attenuation_color, and the medium would, too; leave one of them out"
)
_ROUGH_ADVICE = (
    "rough glass around a medium is not supported; use smooth glass, or glass without a medium"
)
_ROUGH_PRIORITY_ADVICE = (
    "of rough glass is not supported in a scene with media; leave the priority, the roughness or "
    "the media out"
)
_ENDLESS_ADVICE = (
    "shines in a channel in which the medium neither scatters nor absorbs, and it has no end: that "
    "is infinitely bright; give it absorption, or put it into an object that ends"
)
_GLASS_ADVICE = (
    "{} encloses nothing, so it cannot be dielectric; use a sphere, a plane, a box, a "
    "cylinder with caps or a closed mesh, or a material with thin = true"
)
_TEXTURE_ADVICE = (
    "has a texture, and a {} has no texture coordinates; use a mesh of its form, or a material "
    "without textures"
)
