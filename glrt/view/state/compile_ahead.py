"""Compile a kernel in another process, so that the window finds it in the driver's cache.

Drivers compile for 0.3 s and more, during which the window would freeze. `python -m
glrt.view.state.compile_ahead` reads from its input what to compile.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from tempfile import TemporaryFile
from typing import get_args

from glrt.core.errors import ContextError
from glrt.core.version import VERSION
from glrt.gpu.context import Choice, Context, open_context
from glrt.image.recipe import Recipe
from glrt.plan.plan import Layering
from glrt.rendering.passes import Resolved
from glrt.rendering.pipelines import Fast
from glrt.rendering.renderer import Renderer
from glrt.scene.loading.scene_files import with_stand_ins
from glrt.settings import Settings, settings_for

_ROUTES: tuple[Choice, ...] = ("egl", "window")


class CompileAhead:
    """The process that compiles, as the window controls it."""

    def __init__(self, renderer: Renderer, tier: Fast) -> None:
        """Start to compile a kernel for a renderer; OSError if no process can be started."""
        with TemporaryFile("w+", encoding="utf-8") as part:
            part.write(part_of(renderer, tier))
            part.seek(0)
            self._process = subprocess.Popen(
                [sys.executable, "-m", "glrt.view.state.compile_ahead"],
                stdin=part,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )

    @property
    def is_over(self) -> bool:
        """Whether the process has ended, with or without success."""
        return self._process.poll() is not None

    @property
    def succeeded(self) -> bool:
        """Whether the process has ended and the driver has compiled the kernel."""
        return self._process.poll() == 0

    def end(self) -> None:
        """Stop the process: its kernel is no longer needed."""
        self._process.kill()
        self._process.communicate()


def part_of(renderer: Renderer, tier: Fast) -> str:
    """Return a kernel to compile, in two lines: its layering and tier, and a recipe as JSON."""
    plan = renderer.plan
    recipe = Recipe(
        scene=plan.scene,
        settings=plan.settings,
        samples=0,
        version=VERSION,
        renderer=renderer.context.renderer,
        pipeline=renderer.pipeline,
    )
    return f"{plan.layering} {tier}\n{recipe.to_json()}\n"


def compile_part(part: str) -> None:
    """Compile the kernel of a part, in the format of `part_of`.

    Raises ContextError if the driver of the window cannot be opened in this process.
    """
    first, rest = part.split("\n", 1)
    words = first.split()
    layering: Layering = next(name for name in get_args(Layering) if name == words[0])
    tier: Fast = next(name for name in get_args(Fast) if name == words[1])
    with _ready(Recipe.from_json(rest, "The part to compile"), layering) as renderer:
        renderer.bake(tier)


@contextmanager
def _ready(recipe: Recipe, layering: Layering) -> Iterator[Renderer]:
    """Yield a renderer of a small part of the picture, with the same kernel as the window."""
    pipeline: Resolved = "fragment" if recipe.pipeline == "fragment" else "compute"
    context = same_driver(recipe.renderer, pipeline)
    settings = cropped(recipe.settings)
    scene = with_stand_ins(recipe.scene)
    renderer = Renderer(scene, settings, context, pipeline=pipeline, layering=layering)
    yield renderer
    renderer.release()
    context.gl.release()


def same_driver(name: str, pipeline: Resolved) -> Context:
    """Open the driver of this name; ContextError if no route leads to it."""
    for route in _ROUTES:
        try:
            context = open_context(route, pipeline)
        except ContextError:
            continue
        if context.renderer == name:
            return context
        context.gl.release()
    raise ContextError(f"no route leads to {name}")


def cropped(settings: Settings) -> Settings:
    """Return settings for a small part of the picture, which needs the same kernel."""
    sides = settings.width, settings.height
    width, height = map(_small, sides)
    corner = (sides[0] - width) // 2, (sides[1] - height) // 2
    return settings_for(settings, crop=(*corner, width, height))


def _small(side: int) -> int:
    """Return a short side, in pixels, for which the same kernel is compiled.

    llvmpipe compiles another kernel for textures whose sides are powers of two.
    """
    return min(side, 32 if side & (side - 1) == 0 else 24)


if __name__ == "__main__":
    compile_part(sys.stdin.read())
