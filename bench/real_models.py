"""Real models by glrt and by Mitsuba: `python -m bench.real_models MODEL... [-o FILE.md]`.

Each model is shown in its studio, three times. At first it has flat facets and matte surfaces, with
the images of its colours: both renderers can show exactly that, and `glrt compare` says whether
they do. Then it is matte with its own normals. At last it is shown as it is, by `glrt export` to
Mitsuba, whose materials are similar ones. The table has the differences of the whole picture, and
the RMS differences of blocks of 8 x 8 pixels.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bench.processes import ROOT
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.core import files
from glrt.core.errors import RenderError
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.scene.export.companions import Companions
from glrt.scene.export.mitsuba.file import to_mitsuba
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import settings_for

BLOCK = 8  # pixels a side
_DIFFERENT = 1  # exit code of `glrt compare`
HEAD = (
    "| model | triangles | matte facets | matte with its normals | as it is | what Mitsuba shows "
    "otherwise |",
    "|---|---|---|---|---|---|",
)


class Pair(NamedTuple):
    """One scene by both renderers."""

    verdict: str  # of `glrt compare`
    mean: float  # relative difference of glrt's mean from Mitsuba's
    blocks: float  # RMS difference of blocks over the mean

    def __str__(self) -> str:
        """All three, as a cell of the table."""
        return f"{self.verdict}, {100 * self.mean:+.2f} %, blocks {100 * self.blocks:.1f} %"


def matte(scene: Scene) -> Scene:
    """The scene with matte surfaces of the same colours, images of colours included."""
    materials = {name: _matte(material) for name, material in scene.materials.items()}
    return scene.model_copy(update={"materials": materials})


def faceted(scene: Scene) -> Scene:
    """The scene with flat triangles."""
    objects = tuple(
        it.model_copy(update={"smooth": False}) if isinstance(it, Mesh) else it
        for it in scene.objects
    )
    return scene.model_copy(update={"objects": objects})


def _matte(material: Material) -> Material:
    if not isinstance(material, Principled):
        return material
    found = material.color_map
    color = material.color if found is None else found.model_copy(update={"factor": material.color})
    return Principled(color=color, specular=0.0, roughness=1.0)


def differences(ours: Image, theirs: Image) -> tuple[float, float]:
    """The relative difference of the mean, and the RMS difference of blocks over the mean."""
    first, second = (_blocks(image.radiance) for image in (ours, theirs))
    whole = float(second.mean())
    rms = float(np.sqrt(((first - second) ** 2).mean()))
    return float(first.mean()) / whole - 1, rms / whole


def _blocks(pixels: Any) -> Any:
    high, wide = (side // BLOCK * BLOCK for side in pixels.shape[:2])
    parts = pixels[:high, :wide].reshape(high // BLOCK, BLOCK, wide // BLOCK, BLOCK, 3)
    return parts.mean(axis=(1, 3), dtype=np.float64)


def main(arguments: Sequence[str] | None = None) -> int:
    """`python -m bench.real_models`; returns the exit code."""
    parser = parser_of("real_models", __doc__)
    add = parser.add_argument
    add("models", nargs="+", metavar="MODEL", help="files of models")
    add("--size", type=at_least(16), default=128, metavar="N", help="pixels a side (default: 128)")
    add("--samples", type=at_least(16), default=1024, metavar="N", help="default: 1024")
    add("-o", dest="output", type=Path, metavar="FILE.md", help="file for the table")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(arguments: argparse.Namespace) -> None:
    lines = list(HEAD)
    print("\n".join(HEAD))
    for model in arguments.models:
        lines.append(_row(Path(model), arguments))
        print(lines[-1], flush=True)
    text = "\n".join([*lines, "", machine("Mitsuba by tests.mitsuba"), ""])
    if arguments.output:
        files.write_whole(arguments.output, lambda file: _write(file, text))


def _write(file: Path, text: str) -> None:
    file.write_text(text, "utf-8")


def _row(model: Path, arguments: argparse.Namespace) -> str:
    scene = load(model).model_copy(update={"animation": None})
    with tempfile.TemporaryDirectory(prefix="glrt-models-") as place:
        folder = Path(place)
        pairs = []
        for name, found in (("facets", faceted(matte(scene))), ("matte", matte(scene))):
            found.save(folder / f"{name}.toml")
            pairs.append(_pair(folder / f"{name}.toml", None, arguments))
        scene.save(folder / "own.toml")
        companions = Companions(folder / "own.xml")
        size = {"width": arguments.size, "height": arguments.size}
        settings = settings_for(scene.render, **size, samples=arguments.samples)
        text, left_out = to_mitsuba(scene, settings, companions)
        companions.save()
        (folder / "own.xml").write_text(text, "utf-8")
        pairs.append(_pair(folder / "own.toml", folder / "own.xml", arguments))
    triangles = sum(len(it.triangles_of_file.faces) for it in scene.meshes)
    others = "; ".join(sorted({words.partition(" of ")[0] for words in left_out})) or "nothing"
    return f"| {' | '.join([model.name, f'{triangles:,}', *map(str, pairs), others])} |"


def _pair(scene: Path, file: Path | None, arguments: argparse.Namespace) -> Pair:
    size = ["--width", str(arguments.size), "--height", str(arguments.size)]
    common = [*size, "--samples", str(arguments.samples)]
    ours, theirs = (scene.with_name(f"{scene.stem}-{it}.exr") for it in ("ours", "theirs"))
    given = ["--file", str(file)] if file else []
    _run("tests.mitsuba", str(scene), "-o", str(theirs), *common, *given)
    _run("glrt", "render", str(scene), "-o", str(ours), *common, "--sampler", "independent")
    told = _run("glrt", "compare", str(ours), str(theirs), "--json", fine=(0, _DIFFERENT))
    verdict = str(json.loads(told)["verdict"])
    return Pair(verdict, *differences(Image.load(ours), Image.load(theirs)))


def _run(module: str, *words: str, fine: tuple[int, ...] = (0,)) -> str:
    command = [sys.executable, "-m", module, *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode not in fine:
        raise RenderError(f"python -m {module} failed: {done.stderr.strip()[-300:]}")
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
