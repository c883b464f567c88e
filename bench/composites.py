"""Renders next to each other, as pages of docs show them: composites of `bench.pictures`."""

import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from bench.contact_sheet import Codes, save_sheet
from bench.sheets import in_rows, rendered, write_sheet
from glrt.core.errors import UsageError
from glrt.error.estimate import DARK
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.lab.probes import CELL, WITHOUT, house
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

DOCS = Path(__file__).parents[1] / "docs"
GAP = 6  # pixels between pictures
WALL = 0.03 * CELL  # thickness of a wall between two rooms, too thin for a grid of probes
DARKROOM = 5.0  # EV
WORST = 0.2  # relative error that is white
DIFFUSE = "methods/diffuse"


def blur(file: Path) -> None:
    """A ball that falls and a bar that turns, while the shutter is shut and open."""
    still = code_of("how-to/films.md", "# falling.toml")
    frame = {"width": 280, "height": 210, "samples": 256, "denoise": "auto"}
    texts = (still.replace("shutter = 0.5", f"shutter = {it}") for it in ("0.0", "0.5"))
    _save_row(file, [(_decoded(text), frame) for text in texts])


def drink(file: Path) -> None:
    """A glass of water in the sun without particles, and with them."""
    frame = {"width": 320, "height": 320, "samples": 256, "caustics": "off"}
    with_particles = {**frame, "caustics": "on", "particles": 0.25}
    _save_row(file, [(load("drink"), way) for way in (frame, with_particles)])


def glossy(file: Path) -> None:
    """A room with balls of ground glass and rough metal, without particles and with them."""
    scene = load("methods/gap")
    materials = dict(scene.materials)
    materials["glass"] = materials["glass"].model_copy(update={"roughness": 0.15})
    gold = {"roughness": 0.25, "color": (0.95, 0.76, 0.4)}
    materials["mirror"] = materials["mirror"].model_copy(update=gold)
    scene = scene.model_copy(update={"materials": materials})
    frame = {"width": 384, "height": 384, "samples": 128, "caustics": "off"}
    with_particles = {**frame, "caustics": "on", "particles": 0.5, "aimed": 0.5}
    _save_row(file, [(scene, way) for way in (frame, with_particles)])


def denoised(file: Path) -> None:
    """Two rooms at 64 samples: plain, denoised, and the error that is left."""
    context, found = open_context(), []
    for name in ("cornell", "methods/caustic"):
        options: Any = {"width": 384, "height": 384, "samples": 64, "denoise": "nlm"}
        renderer = Renderer(load(name), None, context, "complete", **options)
        image = renderer.render().image()
        renderer.release()
        filtered = image.denoised()
        level = filtered.radiance.mean(axis=-1) ** 2
        squares = np.square(filtered.error_map).mean(axis=-1)
        left = np.sqrt(squares / (level + DARK * level.mean())) / WORST
        grey = np.round(255 * np.minimum(left, 1.0)).astype(np.uint8)
        way = renderer.settings.exposure, renderer.settings.tonemap
        shown = (expose_and_encode(it, *way) for it in (image.radiance, filtered.radiance))
        found += [*shown, np.repeat(grey[..., None], 3, axis=2)]
    context.gl.release()
    save_sheet(found, file)


def gather(file: Path) -> None:
    """A room with two balls by probes, by a final gather, and by paths."""
    frame = {"width": 384, "height": 384, "samples": 1024, "bounces": 64, "probes": 5}
    _save_sheet(
        file, [(load(DIFFUSE), {**frame, "method": it}) for it in ("ddgi", "gather", "mis")]
    )


def reuse(file: Path) -> None:
    """A room by points that samples share, and by a final gather of many samples."""
    frame = {"width": 384, "height": 384, "samples": 16}
    ways: list[dict[str, Any]] = [
        {"method": "gather"},
        *({"method": "resampled", "reuse": it} for it in ("none", "spatial", "both")),
        {"method": "resampled", "reuse": "both", "unbiased": False},
        {"method": "gather", "samples": 1024},
    ]
    _save_sheet(file, [(load(DIFFUSE), {**frame, **way}) for way in ways])


def models(file: Path) -> None:
    """A bare model as it is shown, and two scenes of meshes."""
    frame = {"width": 384, "height": 288, "samples": 256, "denoise": "auto"}
    scenes = "cow.glb", "spot", "methods/mesh"
    folder = DOCS.parent / "scenes" / "models"
    opened = (load(str(folder / it) if it.endswith(".glb") else it) for it in scenes)
    _save_sheet(file, [(scene, frame) for scene in opened])


def leaks(file: Path) -> None:
    """A sealed dark room next to a lit one by probes that leak, that do not, and by paths."""
    scene, context = house(WALL, 1), open_context()
    way: dict[str, Any] = {"width": 200, "height": 150, "samples": 256, "exposure": DARKROOM}
    by_probes = {**way, "method": "ddgi", "sampler": "sobol"}
    without_bias = Variant({"WITHOUT_BIAS": True})
    row = [
        *(rendered(context, scene, it, **by_probes) for it in (WITHOUT, without_bias)),
        rendered(context, scene, **by_probes),
        rendered(context, scene, **way),
    ]
    context.gl.release()
    write_sheet(file, in_rows(row, len(row), 4))


@dataclass(frozen=True)
class One:
    """The picture of one scene: one that comes with glrt, or one whose code a page of docs shows.

    The code is TOML, MaterialX, or Python that ends with `glrt.render(scene, ...)`; its block holds
    `marker`.
    """

    source: str  # name of a scene, or page of docs
    marker: str = ""
    settings: Mapping[str, Any] = field(default_factory=dict, hash=False)

    @property
    def scene(self) -> Scene:
        """The scene; raises UsageError if the page has no such code."""
        if not self.marker:
            return load(self.source)
        code = code_of(self.source, self.marker)
        if code.startswith("<?xml"):
            return _of_document(code)
        return _built(code) if "import glrt" in code else _decoded(code)

    def __call__(self, file: Path) -> None:
        """Render it into a file."""
        _save_row(file, [(self.scene, dict(self.settings))])

    def __str__(self) -> str:
        """The scene and its settings, as one line."""
        settings = ", ".join(f"{name} {value}" for name, value in self.settings.items())
        where = f"docs/{self.source}, block with {self.marker}" if self.marker else self.source
        return f"{where}; {settings}"


def code_of(page: str, marker: str) -> str:
    """Return the fenced code of a page of docs that holds a text; UsageError if none does."""
    text = (DOCS / page).read_text("utf-8")
    for code in re.findall(r"^```\w+\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        if marker in code:
            return str(code)
    raise UsageError(f"docs/{page} has no code with {marker!r}. Restore it, or its entry here.")


def _of_document(code: str) -> Scene:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "looks.mtlx"
        file.write_text(code, "utf-8")
        return load(file)


def _built(code: str) -> Scene:
    names: dict[str, Any] = {}
    exec(code.rpartition("\nglrt.render(")[0], names)
    scene: Scene = names["scene"]
    return scene


def _decoded(text: str) -> Scene:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        file.write_text(text, "utf-8")
        return load(file)


def _save_row(file: Path, cells: Sequence[tuple[Scene, dict[str, Any]]]) -> None:
    pictures = _all(cells)
    write_sheet(file, in_rows(pictures, len(pictures), GAP))


def _save_sheet(file: Path, cells: Sequence[tuple[Scene, dict[str, Any]]]) -> None:
    save_sheet(_all(cells), file)


def _all(cells: Sequence[tuple[Scene, dict[str, Any]]]) -> list[Codes]:
    context: Context = open_context()
    try:
        return [rendered(context, scene, **settings) for scene, settings in cells]
    finally:
        context.gl.release()
