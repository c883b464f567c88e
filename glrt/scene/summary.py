"""The contents of a scene in words, a line for each sort of thing."""

from collections.abc import Iterable, Iterator

from glrt.core.text import counted, number, shortened
from glrt.scene.lit_scene import SKY_GROUP
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import TYPES
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.shapes.mesh import Mesh

MOST_NAMED = 8  # names of a sort


def summary(scene: Scene) -> list[str]:
    """Return lines for objects by kind, materials by type, textures, variants and lights."""
    return [
        f"objects    {', '.join(_objects(scene)) or 'none'}",
        f"materials  {'; '.join(_materials(scene)) or 'none'}",
        *_textures(scene),
        *_variants(scene),
        *([f"media      {few(scene.media)}"] if scene.media else []),
        f"lights     {few(_lights(scene)) or 'none'}",
        *_animation(scene),
    ]


def _animation(scene: Scene) -> list[str]:
    if scene.animation is None:
        return []
    frames = f"{counted(scene.frames, 'frame')} at {number(scene.animation.fps)} a second"
    lines = [f"animation  {frames}: {few([track.target for track in scene.animation.tracks])}"]
    if scene.is_blurred:
        open_for = scene.camera.shutter / scene.animation.fps
        share = f"{number(scene.camera.shutter)} of a frame"
        lines.append(f"shutter    open for {share}, {open_for:.3g} s: what moves is blurred")
    return lines


def _objects(scene: Scene) -> Iterator[str]:
    for kind in KINDS:
        if count := sum(thing.shape == kind for thing in scene.objects):
            yield counted(count, kind) + _triangles(scene, kind)


def _triangles(scene: Scene, kind: str) -> str:
    if kind != "mesh":
        return ""
    meshes = [thing for thing in scene.objects if isinstance(thing, Mesh)]
    return f" of {counted(sum(len(mesh.triangles.faces) for mesh in meshes), 'triangle')}"


def _materials(scene: Scene) -> Iterator[str]:
    for type_ in TYPES:
        names = [name for name, material in scene.materials.items() if material.type == type_]
        if names:
            yield f"{type_} {few(names)}"


def _textures(scene: Scene) -> Iterator[str]:
    opaque = [material for material in scene.materials.values() if isinstance(material, Opaque)]
    textures = [texture for material in opaque for texture in material.textures.values()]
    if not textures:
        return
    images = {texture.image for texture in textures if texture.image is not None}
    texels = [image.texels for image in images if image.texels is not None]
    size = sum(each.nbytes for each in texels) / 2**20
    of_images = f"{counted(len(images), 'image')} of {size:.3g} MiB"
    yield f"textures   {len(textures)}, {of_images}"


def _variants(scene: Scene) -> Iterator[str]:
    """Yield the variants of materials that each model file offers."""
    meshes = [thing for thing in scene.objects if isinstance(thing, Mesh)]
    for file in dict.fromkeys(mesh.file for mesh in meshes):
        if file.triangles is not None and (names := file.triangles.variants):
            yield f"variants   {file.file}: {few(names)}"


def _lights(scene: Scene) -> Iterator[str]:
    """Yield light groups with their intensities; the background only if it is not black."""
    has_sky = any(map(any, scene.background.gradient))
    for group, intensity in scene.light_groups.items():
        if group != SKY_GROUP or has_sky:
            yield f"{group}={number(intensity)}"


def few(words: Iterable[str]) -> str:
    """Return the first of many words, and how many others there are."""
    found = [shortened(word) for word in words]
    rest = f" and {len(found) - MOST_NAMED:,} more" if len(found) > MOST_NAMED else ""
    return ", ".join(found[:MOST_NAMED]) + rest
