"""Report of `glrt render` on a finished render: a line of JSON, or prose."""

import argparse
import sys
from typing import Any, NamedTuple

from glrt.cli.reports.warnings import clipped, doubt, dropped, even, too_dark
from glrt.core.text import counted
from glrt.denoise.filters import least_samples
from glrt.image.image import Image
from glrt.plan.facts import SceneFacts
from glrt.plan.omissions import left_out, omissions
from glrt.plan.plan import Plan
from glrt.process.command import file_names, peak_bytes, print_figures
from glrt.rendering.particle_tracer import Losses
from glrt.rendering.renderer import Renderer
from glrt.scene.loading.scene_files import sources_of
from glrt.scene.scene import Scene
from glrt.settings import Settings


class Driver(NamedTuple):
    """An OpenGL driver of workers, and the route by which it was opened."""

    renderer: str
    route: str


class Finished(NamedTuple):
    """The part of a renderer that a report needs, for a picture that workers have rendered."""

    scene: Scene
    settings: Settings
    pipeline: str
    context: Driver
    lost_particles: Losses = Losses(0, 0)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture or of the crop, in pixels."""
        return self.settings.size

    @property
    def plan(self) -> Plan:
        """The needs of the picture of a kernel."""
        return Plan(SceneFacts(self.scene), self.settings, "none")

    def nonfinite(self) -> int:
        """Number of dropped samples, which the picture itself knows."""
        return 0


class Done(NamedTuple):
    """A finished render."""

    renderer: Renderer | Finished
    image: Image
    begun: int  # samples that each pixel had at the start
    seconds: dict[str, float]

    @property
    def new(self) -> int:
        """Samples of each pixel that this run rendered."""
        return self.image.samples - self.begun

    @property
    def rate(self) -> float:
        """Samples a second, over all pixels."""
        width, height = self.renderer.size
        return self.new * width * height / max(self.seconds["render"], 1e-9)

    @property
    def dropped(self) -> int:
        """Samples and particles that were dropped because they were not finite."""
        state = self.image.film_state
        if state is None:
            return self.renderer.nonfinite()
        return int(state.dropped.sum(dtype=float)) + self.renderer.lost_particles.refused


def report(arguments: argparse.Namespace, done: Done) -> None:
    """Print the figures of a render: a line of JSON on stdout, or prose on stderr."""
    renderer, begun, new = done.renderer, done.begun, done.new
    width, height = renderer.size
    if arguments.json:
        print_figures(_figures(arguments, done), arguments.outputs)
    elif not arguments.quiet:
        more = f" ({new} of them new)" if begun else ""
        print(
            f"Wrote {file_names(arguments.outputs)}: {width} x {height}, "
            f"{counted(done.image.samples, 'sample')}{_spread(done.image)}{more} in "
            f"{done.seconds['render']:.1f} s "
            f"({done.rate / 1e6:.2f} million samples/s){_errors(done.image)}.",
            file=sys.stderr,
        )
    doubts = [
        dropped(done.dropped),
        even(done.image),
        clipped(renderer.lost_particles.clipped),
        doubt(done.image),
        _noisy(done.image),
        too_dark(done.image, arguments.outputs),
    ]
    for text in filter(None, doubts):
        print(f"glrt: caution: {text}", file=sys.stderr)
    if not arguments.quiet and (missing := omissions(renderer.plan.facts, renderer.settings)):
        print(left_out(renderer.settings, missing), file=sys.stderr)


def unreached(
    wanted: float, noise: float, estimate: float | None, samples: int, least: int = 2
) -> str:
    """Return the message about an `--error` of `wanted` that was not reached.

    `noise`: error that the method's bias leaves to noise; `least`: samples from which an error is
    known.
    """
    after = f"after {counted(samples, 'sample')}"
    if estimate is None and samples < least:
        known = f"{least} samples" + (" (2 with --sampler independent)" if least > 2 else "")
        found = f"{after} the error is not known, which takes at least {known}"
    else:
        shown = "unknown" if estimate is None else f"{estimate:.3g}"
        found = f"it is {shown} {after}"
        if noise < wanted:
            found = (
                "after subtracting the bias of the method, its noise must be at most "
                f"{noise:.3g}; {found}"
            )
    return (
        f"--error {wanted:g} was not reached: {found}. The picture is saved; give more --samples "
        "or --time."
    )


def _spread(image: Image) -> str:
    """Return the range of the counts of pixels, if they differ."""
    low, high = int(image.counts.min()), int(image.counts.max())
    return f" on average ({low} to {high})" if low < high else ""


def _errors(image: Image) -> str:
    """Return the known errors as the end of a sentence."""
    plain = "" if image.error is None else f", estimated error {100 * image.error:.2g} %"
    denoised = image.denoising
    return plain if denoised is None else f"{plain}, denoised {100 * denoised.error:.2g} %"


def _noisy(image: Image) -> str | None:
    """Return a caution if the picture has too few samples to be denoised; else None."""
    settings = image.recipe.settings if image.recipe else None
    if settings is None or settings.denoise == "none" or image.denoising:
        return None
    least = least_samples(settings.block)
    return f"the picture is not denoised: that takes {counted(least, 'sample')} at least."


def _figures(arguments: argparse.Namespace, done: Done) -> dict[str, Any]:
    renderer, settings, denoised = done.renderer, done.renderer.settings, done.image.denoising
    return {
        "scene": arguments.scene or arguments.resume,
        "width": settings.width,
        "height": settings.height,
        "samples": done.image.samples,
        "bounces": settings.bounces,
        "method": settings.method,
        "caustics": settings.caustics,
        "seed": settings.seed,
        "pipeline": renderer.pipeline,
        "context": renderer.context.route,
        "renderer": renderer.context.renderer,
        "seconds": {name: round(value, 6) for name, value in done.seconds.items()},
        "samples_per_second": round(done.rate, 1),
        "error": done.image.error,
        "error_doubtful": done.image.error_doubtful,
        "denoised_error": denoised.error if denoised else None,
        "denoised_error_high": denoised.error_high if denoised else None,
        "nonfinite": done.dropped,
        "peak_bytes": peak_bytes(),
        "triangles": renderer.plan.facts.triangles,
        "assets": sources_of(renderer.scene),
    }
