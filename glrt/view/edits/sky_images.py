"""Images of all directions that become the background of a scene."""

from pathlib import Path

from glrt.core.errors import UsageError
from glrt.image.image import read_recipe
from glrt.scene.files.assets import AssetFolder, AssetReader
from glrt.scene.files.named_images import ImageFile
from glrt.scene.files.path_text import text_of
from glrt.scene.lights.background import Background
from glrt.scene.loading.file_contents import with_content
from glrt.scene.scene import Scene
from glrt.view.controls import made, replaced

SKIES = (".hdr", ".exr")  # suffixes of images of radiance


def is_sky(path: Path) -> bool:
    """Whether a file is an image of radiance by its name, and no picture with a recipe.

    Raises `SceneError` for a damaged EXR file.
    """
    if path.suffix.lower() != ".exr":
        return path.suffix.lower() in SKIES
    try:
        read_recipe(path)
    except UsageError:
        return True
    return False


def with_sky_image(scene: Scene, path: Path) -> Scene:
    """Return the scene with an image as its background; the intensity of that light stays.

    A save copies the image next to the scene file. Raises `SceneError` if it is no image.
    """
    reader = AssetReader(AssetFolder(path.absolute().parent))
    named = made(ImageFile, {"file": text_of(path.name)})
    image = with_content(named, reader, str(path.parent))
    return replaced(scene, background=made(Background, {"image": image}))
