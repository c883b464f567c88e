"""A converted file as a glTF file, with materials, lights and lenses as tables of a scene."""

from pathlib import Path
from typing import Any

from glrt.scene.meshes.triangle_meshes import NO_MATERIAL
from glrt.scene.model_files.conversion.outcome import KEY
from glrt.scene.model_files.conversion.process import Library, glb_of
from glrt.scene.model_files.gltf.document import Document, Fetch
from glrt.scene.model_files.gltf.images import image_place
from glrt.scene.model_files.gltf.materials import Look, fit_glass, grey
from glrt.scene.model_files.gltf.primitives import material_names

Table = dict[str, Any]


class ConvertedDocument(Document):
    """A converted file: nodes, meshes, cameras and images as in glTF, the rest as tables."""

    def __init__(
        self, library: Library, file: Path, base: Path, allow_outside: bool, fetch: Fetch
    ) -> None:
        """Convert a file; `fetch` reads the other files that it was made of, and those of images.

        Raises `ConversionError`.
        """
        super().__init__(glb_of(library, file, base, allow_outside), fetch)
        self._own: Table = self.json["extras"][KEY]
        for path in self._own["layers"]:
            fetch(path)

    @property
    def left_out(self) -> list[str]:
        """Parts of the file that are left out, in words."""
        found: list[str] = self._own["left_out"]
        return found

    def lens(self, node: int) -> Table:
        """Return the focus of the camera of a node, as keys of a scene's camera."""
        found: Table = self._own["lenses"].get(str(node), {})
        return found

    def lights(self, path: str) -> Table:
        """Return lights as tables of a scene: materials, objects, suns, perhaps a background.

        `path` is that of the file in the scene.
        """
        found = dict(self._own["lights"])
        if "image" in found.get("background", {}):
            found["background"] = self._with_image(found["background"], path)
        return found

    def looks(self, path: str) -> dict[str, Look]:
        """Return the materials of the file by their names; `path` is its own in the scene."""
        pairs = zip(material_names(self), self._own["looks"], strict=True)
        return {**{name: self._look(it, path) for name, it in pairs}, NO_MATERIAL: grey()}

    def _look(self, given: Table, path: str) -> Look:
        table = {
            key: self._with_image(value, path) if isinstance(value, dict) else value
            for key, value in given["table"].items()
        }
        look = Look(table, hides_backs=not given["is_two_sided"])
        if table.get("transmission"):
            fit_glass(look)
        return look

    def _with_image(self, table: Table, path: str) -> Table:
        """Return a table with the path of its image in place of the number."""
        place = image_place(self, table["image"], "a texture")
        folder = path.rpartition("/")[0] + "/" if "/" in path else ""
        inside = f"{path}#{place.number}"
        return {**table, "image": inside if place.path is None else folder + place.path}
