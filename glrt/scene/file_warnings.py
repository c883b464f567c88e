"""Warnings about files that a scene names: what is left out, made smaller, or wrong in glass."""

from collections.abc import Iterator

from glrt.core.text import counted, quoted
from glrt.scene.images.texture_sizes import MOST_TEXELS, sizes_of
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import glass_of
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.summary import few

LEAST_ROUNDED = 0.1  # share of a mesh: less may be a few creases of a scanned thing


def repeated(scene: Scene) -> Iterator[str]:
    """Yield a warning for each file that holds triangles twice."""
    meshes = [thing for thing in scene.objects if isinstance(thing, Mesh)]
    for file, mesh in {mesh.file: mesh for mesh in reversed(meshes)}.items():
        if file.triangles is not None and (count := mesh.triangles_of_file.repeated):
            verb = "repeats another one" if count == 1 else "repeat others"
            yield f"{file.file}: {counted(count, 'triangle')} {verb}, and each is there once."


def unread(scene: Scene) -> Iterator[str]:
    """Yield a warning for each model file with content that is left out."""
    meshes = [thing for thing in scene.objects if isinstance(thing, Mesh)]
    for file in dict.fromkeys(mesh.file for mesh in meshes if mesh.file.unread):
        where = ", ".join(file.libraries)
        place = f"{where}: left out of {file.file}" if where else f"{file.file}: left out"
        yield (
            f"{place}: {few(file.unread)}. docs/how-to/models.md says what is read; a `material` "
            "of the scene gives an object another look."
        )


def rounded_glass(scene: Scene) -> Iterator[str]:
    """Yield a warning for each mesh of glass whose sharp edges are rounded off by its normals."""
    for index, thing in enumerate(scene.objects):
        if not isinstance(thing, Mesh) or thing.hidden or thing.smooth is not True:
            continue
        glass = glass_of(scene.materials[thing.material])
        if glass is None or glass.thin or (share := thing.triangles.rounded) < LEAST_ROUNDED:
            continue
        yield (
            f"objects[{index}]{f' {quoted(thing.name)}' if thing.name else ''}: "
            f"{thing.file.file} has no normals, so they are means over edges that are sharp, on "
            f"{100 * share:.0f} % of its area. Glass refracts by them, as if flat faces were "
            'rounded. Write smooth = "auto" to keep edges sharp, or smooth = false for flat facets.'
        )


def large_images(scene: Scene) -> str:
    """Return a warning of images that are made smaller; empty if none is."""
    opaque = [it for it in scene.materials.values() if isinstance(it, Opaque)]
    images = {t.image for it in opaque for t in it.textures.values() if t.image is not None}
    texels = {image.file: image.texels.shape[:2] for image in images if image.texels is not None}
    sizes = sizes_of(list(texels.values()))
    smaller = [file for file, size in zip(texels, sizes, strict=True) if texels[file] != size]
    if not smaller:
        return ""
    return (
        f"the images of this scene have more than {MOST_TEXELS >> 20} million pixels together: "
        f"{few(smaller)} {'is' if len(smaller) == 1 else 'are'} made smaller. Use smaller ones."
    )
