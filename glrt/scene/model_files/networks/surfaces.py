"""The surfaces that are known, by the categories of their nodes."""

from collections.abc import Callable

from glrt.scene.model_files.networks import (
    gltf_surface,
    open_pbr,
    preview_surface,
    standard_surface,
)
from glrt.scene.model_files.networks.evaluation import Evaluation
from glrt.scene.model_files.networks.inputs import Defaults, Inputs
from glrt.scene.model_files.networks.nodes import Node, Table

Reading = Callable[[Inputs], Table]
_READINGS: dict[str, tuple[Reading, Defaults]] = {
    "UsdPreviewSurface": (preview_surface.preview_surface, preview_surface.DEFAULTS),
    "standard_surface": (standard_surface.standard_surface, standard_surface.DEFAULTS),
    "open_pbr_surface": (open_pbr.open_pbr, open_pbr.DEFAULTS),
    "gltf_pbr": (gltf_surface.gltf_surface, gltf_surface.DEFAULTS),
}
SURFACES = tuple(_READINGS)


def is_surface(category: str) -> bool:
    """Return whether a node of this category is a surface that is known."""
    return category in _READINGS


def surface_table(node: Node, evaluation: Evaluation) -> tuple[Table, str | None]:
    """Return a surface as the table of a principled material, and its colors of vertices.

    The second is the name of these colors; None if the surface has none.
    """
    read, defaults = _READINGS[node.category]
    inputs = Inputs(node, evaluation, defaults)
    table = {"type": "principled", **read(inputs)}
    _fit(table, inputs)
    return table, inputs.colors


def _fit(table: Table, inputs: Inputs) -> None:
    """Leave out what a principled material cannot have together."""
    emission = table.get("emission")
    if emission is not None and not isinstance(emission, dict) and "alpha" in table:
        del table["alpha"]
        table.pop("alpha_cutoff", None)
        inputs.left.add("opacity of what emits")
