"""The table of docs/results/platforms.md: every scene by route and pipeline.

`python -m tests.project.matrix`: each way draws every scene in a process of its own, by the tier of
`glrt render`. A cell says `=` where radiance and standard error have the bits of the first way,
else how far they differ: the root mean square of the radiance over that of another seed.
"""

import argparse
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.screens import screen
from glrt.core.resources import folder
from glrt.gpu.context import Choice, open_context
from glrt.image.sources import load
from glrt.rendering.passes import Resolved
from glrt.rendering.renderer import Renderer
from glrt.scene.scenefile.catalog import scene_names
from tests.support.drivers import OLD_DRIVER, ZINK

ROOT = Path(__file__).parents[2]
METHODS = sorted((folder("scenes") / "methods").glob("*.toml"))
SCENES = (*scene_names(), *(f"methods/{file.stem}" for file in METHODS))
SIZE: dict[str, Any] = {"width": 48, "height": 32}
SAMPLES = 4

DRIVERS = {"": {}, "OpenGL 4.1": OLD_DRIVER, "zink": ZINK}
Pictures = Mapping[str, NDArray[np.float32]]


class Way(NamedTuple):
    """A route and a pipeline, perhaps on another driver of DRIVERS."""

    route: Choice
    pipeline: Resolved
    driver: str = ""

    @property
    def title(self) -> str:
        """The title as the head of a column."""
        return f"{self.route} {self.pipeline}{', ' if self.driver else ''}{self.driver}"


WAYS = (
    Way("egl", "compute"),
    Way("egl", "fragment"),
    Way("osmesa", "compute"),
    Way("osmesa", "fragment"),
    Way("window", "compute"),
    Way("window", "fragment"),
    Way("egl", "fragment", "OpenGL 4.1"),
    Way("osmesa", "fragment", "OpenGL 4.1"),
    Way("window", "fragment", "OpenGL 4.1"),
    Way("egl", "compute", "zink"),
    Way("egl", "fragment", "zink"),
)


def drawn(way: Way, scenes: Sequence[str]) -> dict[str, NDArray[np.float32]]:
    """Every scene by this way, in a process of its own, and with another seed."""
    with ExitStack() as stack:
        file = Path(stack.enter_context(TemporaryDirectory())) / "drawn.npz"
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
        environment |= DRIVERS[way.driver]
        if way.route == "window" and shutil.which("Xvfb"):
            environment["DISPLAY"] = stack.enter_context(screen())
        words = [way.route, way.pipeline, str(file), *scenes]
        subprocess.run(
            [sys.executable, "-c", "from tests.project.matrix import draw; draw()", *words],
            env=environment,
            check=True,
        )
        with np.load(file) as found:
            return dict(found)


def draw() -> None:
    """Write the pictures by route and pipeline into a file: the part that the process runs."""
    route, pipeline, file, *scenes = sys.argv[1:]
    context = open_context(route, pipeline)  # type: ignore[arg-type]
    pictures: dict[str, Any] = {"renderer": f"{context.renderer}, OpenGL {context.version}"}
    for name in scenes:
        for seed in (0, 1):
            kind: Any = {"tier": "complete", "pipeline": pipeline, "seed": seed, **SIZE}
            renderer = Renderer(load(name), context=context, **kind)
            image = renderer.render(SAMPLES).image()
            pictures[f"{name} {seed}"] = np.stack([image.radiance, image.stderr])
            renderer.release()
    np.savez(file, **pictures)


def difference(name: str, found: Pictures, first: Pictures) -> str:
    """`=`, or how far a picture lies from that of the first way."""
    one, other, reseeded = found[f"{name} 0"], first[f"{name} 0"], first[f"{name} 1"]
    if one.tobytes() == other.tobytes():
        return "="
    apart, noise = (np.square(picture[0] - other[0]).mean() for picture in (one, reseeded))
    return f"{np.sqrt(apart / noise):.1e}"


def table(ways: Sequence[Way], scenes: Sequence[str]) -> Iterator[str]:
    """Lines of Markdown: what drew, then a row a way, a column a scene."""
    pictures = {way: drawn(way, scenes) for way in ways}
    for name in sorted({str(found["renderer"]) for found in pictures.values()}):
        yield f"- {name}"
    yield f"| {' | '.join(['', *scenes])} |"
    yield f"|---{len(scenes) * '|---'}|"
    first = pictures[ways[0]]
    for way, found in pictures.items():
        cells = (difference(name, found, first) for name in scenes)
        yield f"| {' | '.join([way.title, *cells])} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.project.matrix", description=__doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES)
    for line in table(WAYS, parser.parse_args().scenes):
        print(line)


if __name__ == "__main__":
    main()
