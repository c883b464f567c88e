"""The images that a glTF file holds or names."""

from typing import Any, NamedTuple

from glrt.scene.model_files.gltf.document import Document, path_of


class ImagePlace(NamedTuple):
    """Where an image lies: in a file of its own, or in the glTF file under its number."""

    path: str | None  # path of the image's file, from the glTF file; None if it is inside
    number: int


def image_place(document: Document, index: Any, where: str) -> ImagePlace:
    """Return the place of an image by its number."""
    image = document.item("images", index, where)
    uri = image.get("uri")
    if isinstance(uri, str) and not uri.startswith("data:"):
        return ImagePlace(path_of(uri, f"images[{index}].uri"), index)
    return ImagePlace(None, index)


def image_content(document: Document, index: int) -> bytes:
    """Return the bytes of an image that the file itself holds."""
    image, here = document.item("images", index, "the name of the image"), f"images[{index}]"
    if "uri" in image:
        return document.content(image["uri"], f"{here}.uri")
    return bytes(document.view(image.get("bufferView"), here)[0])
