"""Views that the window draws with shaders, as pages of docs show them: AOVs and probes."""

from pathlib import Path
from typing import Any, get_args

import moderngl
import numpy as np

from bench.composites import DARKROOM, DIFFUSE, WALL
from bench.contact_sheet import Codes, save_sheet
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.lab.probes import WITHOUT, house
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.aov_view import AovView
from glrt.rendering.screen.false_colors import VIRIDIS, FalseColors, Scale
from glrt.rendering.screen.probe_balls import ProbeBalls, farthest
from glrt.scene.scene import Scene
from glrt.settings import TERMS, Aov

SIZE, SAMPLES = 384, 256  # of each picture of probes


def aovs(file: Path) -> None:
    """A render and its AOVs of first surfaces, as the window shows them."""
    names = tuple(it for it in get_args(Aov) if it not in TERMS)
    frame: dict[str, Any] = {"width": 480, "height": 270, "samples": 128}
    context = open_context()
    renderer = Renderer(load("weekend"), None, context, "complete", aov=names, **frame)
    renderer.render().image()
    shown = [renderer.display(), *(_aov(renderer, name) for name in names)]
    renderer.release()
    context.gl.release()
    save_sheet(shown[:6], file)


def _aov(renderer: Renderer, name: Aov) -> Codes:
    gl, settings = renderer.context.gl, renderer.settings
    mean = renderer.aov_mean(name)
    assert mean
    with gl:
        view, target = AovView(gl), gl.simple_framebuffer(renderer.size, 3)
        with gl.scope(target):
            view.draw(name, mean, renderer.scene.camera, settings, settings.bounces)
        codes = _read(target)
        view.release()
        target.release()
    return codes


def probe_balls(file: Path) -> None:
    """Probes as balls with their light, and below with how far they see, in three rooms."""
    context, dark = open_context(), house(WALL, 1)
    rooms = [
        _balls(context, load(DIFFUSE)),
        _balls(context, dark, DARKROOM, WITHOUT),
        _balls(context, dark, DARKROOM),
    ]
    context.gl.release()
    save_sheet([*(light for light, _ in rooms), *(seen for _, seen in rooms)], file)


def _balls(
    context: Context, scene: Scene, exposure: float = 0.0, variant: Variant = PLAIN
) -> tuple[Codes, Codes]:
    """A picture with probes as balls that show their light, and one with their distances."""
    way: dict[str, Any] = {"width": SIZE, "height": SIZE, "samples": SAMPLES, "method": "ddgi"}
    ways = {**way, "aov": ("depth",), "sampler": "sobol"}
    renderer = Renderer(scene, None, context, variant=variant, **ways)
    renderer.render().image()
    with context.gl:
        balls, colors = ProbeBalls(context.gl), FalseColors(context.gl)
        target = context.gl.simple_framebuffer((SIZE, SIZE), 3)
        tracer, depth = renderer.probes.tracer, renderer.aov_mean("depth")
        assert tracer
        assert depth
        light = renderer.weighed(renderer.plan.weights)
        drawn = balls.draw(light, depth.texture, tracer, scene.camera)
        radiance = np.frombuffer(drawn.read(), np.float32).reshape(SIZE, SIZE, 4)[..., :3]
        scale = Scale(VIRIDIS, 0.0, farthest(tracer.grid), is_logarithmic=False)
        with context.gl.scope(target, moderngl.NOTHING):
            colors.draw_distances(renderer.film, light, drawn, scale)
        distances = _read(target)
        for part in (balls, colors, target):
            part.release()
    renderer.release()
    return expose_and_encode(radiance, exposure, "neutral"), distances


def _read(target: moderngl.Framebuffer) -> Codes:
    width, height = target.size
    codes = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
    return codes.reshape(height, width, 3)[::-1].copy()
