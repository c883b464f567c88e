"""Images that become the color of an object."""

from pathlib import Path
from typing import Any

from glrt.core.errors import SceneError, UsageError
from glrt.core.text import quoted
from glrt.image.image import read_recipe
from glrt.scene.files.assets import AssetFolder, AssetReader
from glrt.scene.files.named_images import ColorImage, TextureImage
from glrt.scene.files.path_text import text_of
from glrt.scene.loading.file_contents import with_content
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.textures import Texture
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import WHITE
from glrt.view.controls import made, replaced
from glrt.view.edits.scene_edits import with_own_material

TEXTURES = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga")  # suffixes of images of colors


def is_texture(path: Path) -> bool:
    """Whether a file is an image of colors by its name, and no picture with a recipe."""
    if path.suffix.lower() != ".png":
        return path.suffix.lower() in TEXTURES
    try:
        read_recipe(path)
    except UsageError:
        return path.is_file()
    except SceneError:  # a damaged recipe: whoever opens the picture says so
        return False
    return False


def with_texture_image(scene: Scene, index: int, path: Path) -> Scene:
    """Return the scene in which an image is the color of object `index` alone.

    A material that other objects share is copied first. A save copies the image next to the scene
    file. Raises `SceneError` if it is no image, `UsageError` if it cannot lie on that object.
    """
    shape = scene.objects[index]
    material = scene.materials[shape.material]
    if not (isinstance(material, Opaque) and "color" in material.textured):
        raise UsageError(
            f"Material {quoted(shape.material)} is of type {material.type}, which takes no image. "
            "Choose another type: lambertian, metal or principled."
        )
    if not shape.has_coordinates:
        raise UsageError(
            f"An image cannot lie on a {shape.shape}: it has no texture coordinates. Spheres, "
            "planes, quads, disks and meshes have them."
        )
    if isinstance(shape, Mesh) and shape.triangles_of_file.uv is None:
        raise UsageError(
            f"{shape.file.file} has no texture coordinates, so no image can lie on it. Export it "
            "with them."
        )
    texture = made(Texture, {"image": image_in(path)})
    if sum(other.material == shape.material for other in scene.objects) > 1:
        scene = with_own_material(scene, index)
    name = scene.objects[index].material
    changes: dict[str, Any] = {"color": WHITE, "color_map": texture}
    if isinstance(material, Metal):  # reflects by its color alone
        changes |= {"preset": None, "ior": None, "k": None}
    materials = {**scene.materials, name: replaced(scene.materials[name], **changes)}
    return replaced(scene, materials=materials)


def with_image_read(scene: Scene, path: Path) -> Scene:
    """Return the scene with a material more that has an image, as a place of its content."""
    texture = made(Texture, {"image": image_in(path)})
    spare = Lambertian(color=WHITE).model_copy(update={"color_map": texture})
    return scene.model_copy(update={"materials": {**scene.materials, "": spare}})


def image_in(path: Path) -> TextureImage:
    """Return the image of colors in a file; `SceneError` if it is none."""
    reader = AssetReader(AssetFolder(path.absolute().parent))
    named = made(ColorImage, {"file": text_of(path.name)})
    image = with_content(named, reader, str(path.parent))
    assert isinstance(image, TextureImage)
    return image
