"""Compile a kernel ahead in another process, so that the window finds it in the driver's cache.

Drivers compile for 0.3 s and more, in which a window would stand still. `python -m
glrt.view.state.idle_compile` reads from its input what is to be rendered, and prints what it found.
"""

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from tempfile import TemporaryFile
from typing import NamedTuple, get_args

from glrt.core.errors import ContextError
from glrt.core.version import VERSION
from glrt.gpu.context import Choice, Context, open_context
from glrt.image.recipe import Recipe
from glrt.plan.plan import Layering
from glrt.rendering.passes import Resolved
from glrt.rendering.renderer import Renderer
from glrt.scene.loading.scene_files import with_stand_ins
from glrt.settings import Settings, settings_for

_ROUTES: tuple[Choice, ...] = ("egl", "window")
TIMES = 3  # that compiling from the cache is timed: the least counts, whatever else runs


class Finding(NamedTuple):
    """What is known of a faster kernel before the window compiles it."""

    seconds: float  # to compile it, when it is in the driver's cache
    is_same: bool  # whether it gives the bits of the kernel that it is to relieve


class TrialCompile:
    """The process, seen from the window."""

    def __init__(self, renderer: Renderer) -> None:
        """Begin; OSError if no process can be started."""
        with TemporaryFile("w+", encoding="utf-8") as part:
            part.write(part_of(renderer))
            part.seek(0)
            self._process = subprocess.Popen(
                [sys.executable, "-m", "glrt.view.state.idle_compile"],
                stdin=part,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )

    @property
    def is_over(self) -> bool:
        """Whether the process has ended, for better or worse."""
        return self._process.poll() is not None

    def finding(self) -> Finding | None:
        """What it found; None if it failed. Once, when it is over."""
        told, _ = self._process.communicate()
        return None if self._process.returncode else Finding(**json.loads(told))

    def end(self) -> None:
        """Stop it: what it would find is of no use any more."""
        self._process.kill()
        self._process.communicate()


def part_of(renderer: Renderer) -> str:
    """What a renderer traces, in two lines."""
    plan = renderer.plan
    recipe = Recipe(
        scene=plan.scene,
        settings=plan.settings,
        samples=0,
        version=VERSION,
        renderer=renderer.context.renderer,
        pipeline=renderer.pipeline,
    )
    return f"{plan.layering}\n{recipe.to_json()}\n"


def rehearse(part: str) -> Finding:
    """Compile the kernel, hold it against the other, and compile it again as the window will.

    ContextError if the driver of the window is not to be had here.
    """
    first, rest = part.split("\n", 1)
    layering: Layering = next(name for name in get_args(Layering) if name == first)
    recipe = Recipe.from_json(rest, "The part to rehearse")
    with _ready(recipe, layering) as renderer:
        count = 2 * renderer.settings.block + 1
        expected = renderer.render(count).image()
        renderer.bake()
        renderer.restart()
        image = renderer.render(count).image()
    pairs = (image.radiance, expected.radiance), (image.stderr, expected.stderr)
    is_same = all(left.tobytes() == right.tobytes() for left, right in pairs)
    return Finding(min(_compile_seconds(recipe, layering) for _ in range(TIMES)), is_same)


def _compile_seconds(recipe: Recipe, layering: Layering) -> float:
    """In a context that knows no kernel yet."""
    with _ready(recipe, layering) as renderer:
        start = time.perf_counter()
        renderer.bake()
        return time.perf_counter() - start


@contextmanager
def _ready(recipe: Recipe, layering: Layering) -> Iterator[Renderer]:
    """A renderer of a small part of the picture, by the kernel that the window has."""
    pipeline: Resolved = "fragment" if recipe.pipeline == "fragment" else "compute"
    context = _same_driver(recipe.renderer, pipeline)
    settings = _cropped(recipe.settings)
    scene = with_stand_ins(recipe.scene)
    renderer = Renderer(scene, settings, context, pipeline=pipeline, layering=layering)
    yield renderer
    renderer.release()
    context.gl.release()


def _same_driver(name: str, pipeline: Resolved) -> Context:
    for route in _ROUTES:
        try:
            context = open_context(route, pipeline)
        except ContextError:
            continue
        if context.renderer == name:
            return context
        context.gl.release()
    raise ContextError(f"no route leads to {name}")


def _cropped(settings: Settings) -> Settings:
    sides = settings.width, settings.height
    width, height = map(_small, sides)
    corner = (sides[0] - width) // 2, (sides[1] - height) // 2
    return settings_for(settings, crop=(*corner, width, height))


def _small(side: int) -> int:
    """A short side for a picture that is compiled for alike.

    llvmpipe compiles a kernel apart for textures whose sides are powers of two.
    """
    return min(side, 32 if side & (side - 1) == 0 else 24)


if __name__ == "__main__":
    print(json.dumps(rehearse(sys.stdin.read())._asdict()))
