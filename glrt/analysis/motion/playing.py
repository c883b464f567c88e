"""Play a moving picture as a temporal mode shows it: without a window and without a clock."""

import time
from collections.abc import Iterator
from typing import Any, NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.analysis.motion.sequences import Sequence
from glrt.gpu.context import Context, Pipeline
from glrt.rendering.history.temporal import Temporal, Way
from glrt.rendering.history.upsample import PAIR
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

Picture = NDArray[np.float32]  # (H, W, 3) radiance, row 0 on top


class Played(NamedTuple):
    """One way to play a sequence."""

    settings: Settings
    way: Way
    hysteresis: float | None = None  # of live probes
    pipeline: Pipeline = "auto"
    enlarged: tuple[int, int] | None = None  # width and height that smaller pictures are shown at


def play(
    sequence: Sequence,
    played: Played,
    context: Context,
    samples: int = 1,
    more: list[float] | None = None,
    seconds: list[float] | None = None,
) -> Iterator[Picture]:
    """Yield what is on the screen at the end of each frame, with `samples` per pixel and frame.

    Frame n takes its random numbers from seed `settings.seed` + n, so that frames have independent
    noise. The mode upsample samples some pixels alone, where it can, and never begins a film.
    `more` receives the samples per pixel that each frame takes in addition to `samples`, below 0 if
    it takes fewer. `seconds` receives the time from the edit of each frame until its picture is on
    the driver; reading it, and enlarging it here, do not count. With a hysteresis, probes continue
    from frame to frame, and each frame restarts the film, whether or not something moves.
    """
    settings, way, hysteresis, pipeline, size = played
    renderer = Renderer(sequence.scenes[0], settings, context, pipeline=pipeline)
    temporal = Temporal(context.gl, way)
    last: Scene | None = None
    try:
        for number, scene in enumerate(sequence.scenes):
            start = time.perf_counter()
            if scene != renderer.scene or (number and hysteresis is not None):
                temporal.leave(renderer)
                renderer.update(scene, hysteresis=hysteresis, seed=settings.seed + number)
                temporal.arrive(renderer)
            if temporal.can_upsample(renderer):
                temporal.upsample(renderer)
            else:
                renderer.render(renderer.samples + samples)
            before = temporal.more_samples if scene == last else 0.0
            picture, last = screen_of(renderer, temporal, start, seconds), scene
            if more is not None:
                own = _of_lattice(temporal) - samples if temporal.coarse(renderer) else 0.0
                more.append(temporal.more_samples - before + own)
            yield enlarged(picture, size) if size else picture
    finally:
        temporal.release()
        renderer.release()


def _of_lattice(temporal: Temporal) -> float:
    """Samples per pixel of a coarse picture."""
    assert temporal.upsampled
    return PAIR / temporal.upsampled.last_factor**2


def enlarged(picture: Picture, size: tuple[int, int]) -> Picture:
    """A picture (H, W, 3) in another width and height, linear between its pixels as on a screen."""
    for axis, wanted in ((1, size[0]), (0, size[1])):
        given = picture.shape[axis]
        at = np.clip((np.arange(wanted) + 0.5) * given / wanted - 0.5, 0, given - 1)
        low = at.astype(int)
        share = np.expand_dims(at - low, (2, 1 - axis)).astype(np.float32)
        one, other = (picture.take(np.minimum(low + step, given - 1), axis=axis) for step in (0, 1))
        picture = one + share * (other - one)
    return picture


def screen_of(
    renderer: Renderer,
    temporal: Temporal,
    start: float = 0.0,
    seconds: list[float] | None = None,
) -> Picture:
    """The radiance that is shown now, (H, W, 3); `seconds` receives the time since `start`."""
    shown = temporal.show(renderer)
    with renderer.context.gl:
        texture = shown or renderer.weighed(renderer.plan.weights)
        if seconds is not None:
            renderer.context.gl.finish()
            seconds.append(time.perf_counter() - start)
        return read_texture(texture)[..., :3].copy()


def read_texture(texture: moderngl.Texture) -> NDArray[Any]:
    """A float texture, (H, W, 4); its context must be current."""
    width, height = texture.size
    return np.frombuffer(texture.read(), np.float32).reshape(height, width, 4)
