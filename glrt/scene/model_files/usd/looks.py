"""Materials of a USD file, as tables of principled materials of a scene."""

from dataclasses import dataclass, field

from pxr import Usd, UsdShade

from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.networks.coordinates import Coordinates
from glrt.scene.model_files.networks.evaluation import Evaluation
from glrt.scene.model_files.networks.nodes import Table
from glrt.scene.model_files.networks.surfaces import is_surface, surface_table
from glrt.scene.model_files.usd.images import Images
from glrt.scene.model_files.usd.nodes import UsdNode

COLORS = "displayColor"  # the primvar of colors of vertices, and the name of their material
_SETS = "st", "st1"  # of texture coordinates, by their numbers in networks of MaterialX


@dataclass
class UsdLook:
    """A material: a table of a scene, and which primvars its meshes must have."""

    name: str
    table: Table
    sets: list[str] = field(default_factory=list)  # of texture coordinates, two at most
    colors: str | None = None  # of vertices
    is_two_sided: bool = False  # whether a mesh of it is


def display_look() -> UsdLook:
    """Return the look of meshes that have colors of vertices, and no material."""
    table = {"type": "principled", "color": [1.0, 1.0, 1.0], "roughness": 0.5}
    return UsdLook(COLORS, table, colors=COLORS)


class Looks:
    """The materials of a file by their paths, each read once."""

    def __init__(self, images: Images, left: LeftOut, time: Usd.TimeCode) -> None:
        self._images, self._left, self._time = images, left, time
        self._numbers: dict[str, int | None] = {}
        self._plain: int | None = None
        self.found: list[UsdLook] = []

    def number(self, material: UsdShade.Material | None, has_colors: bool) -> int | None:
        """Return the number of a material among those found.

        Without a material that can be read, it is that of colors of vertices, if there are any.
        """
        path = str(material.GetPath()) if material else ""
        if path not in self._numbers:
            look = self._look(material) if material else None
            self._numbers[path] = self._added(look) if look else None
        if self._numbers[path] is not None or not has_colors:
            return self._numbers[path]
        if self._plain is None:
            self._plain = self._added(display_look())
        return self._plain

    def _added(self, look: UsdLook) -> int:
        self.found.append(look)
        return len(self.found) - 1

    def _look(self, material: UsdShade.Material) -> UsdLook | None:
        shader = material.ComputeSurfaceSource()[0] or material.ComputeSurfaceSource("mtlx")[0]
        if not shader:
            self._left.add("materials without a surface")
            return None
        node = UsdNode(shader, self._images, self._time)
        if not is_surface(node.category):
            self._left.name("materials of", str(shader.GetShaderId() or "code"))
            return None
        look = UsdLook(material.GetPrim().GetName(), {})
        is_preview = node.category == "UsdPreviewSurface"  # whose textures name their coordinates
        coordinates = Coordinates(look.sets, None if is_preview else _SETS[0], _SETS)
        evaluation = Evaluation(coordinates, self._left)
        look.table, colors = surface_table(node, evaluation)
        look.colors = COLORS if colors == "" else colors
        is_moved = node.source("displacement") or node.value("displacement")
        if is_moved and material.GetDisplacementOutput().HasConnectedSource():
            self._left.add("displacement")
        return look
