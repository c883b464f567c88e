"""`glrt inspect --error` recommends a denoiser where its measured error suffices."""

import math
from dataclasses import replace

import numpy as np
import pytest

from glrt.analysis.method_choice.advice import denoised_advice
from glrt.analysis.method_choice.candidate import Bias, Candidate
from glrt.analysis.method_choice.denoised import MOST_PIXELS, DenoisedChoice, denoised_choice
from glrt.analysis.method_choice.search import Verdict
from glrt.analysis.reference import Floats, Reference
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for

ROOM = load("methods/diffuse")
WANTED = settings_for(ROOM.render, width=64, height=64, bounces=6)


def chosen(variance: float, bias: float = 0.0) -> Candidate:
    """A method whose plain pictures have this relative variance of a sample."""
    return Candidate("mis", WANTED, Bias(bias**2, 0.0), variance, 1.0, 1e-3)


@pytest.mark.slow
def test_what_is_recommended_reaches_the_error_in_truth(context: Context) -> None:
    error = 0.05
    found = denoised_choice(ROOM, chosen(8.0), error, context)  # plain: 3,200 samples
    assert found
    assert 64 <= found.samples <= 1600
    assert found.error <= found.high <= error
    assert found.size == (64, 64)
    settings = settings_for(WANTED, samples=found.samples, denoise=found.by)
    errors = []
    truths = [picture(seed, 1024, context) for seed in (7, 8)]
    scale = np.square(sum(truths) / 2) + 0.01 * np.mean(truths) ** 2
    for seed in range(4):
        renderer = Renderer(ROOM, settings, context, seed=seed)
        shown = renderer.render().image().denoised().radiance.astype(np.float64)
        renderer.release()
        errors.append(float(((shown - truths[0]) * (shown - truths[1]) / scale).mean()))
    assert math.sqrt(np.mean(errors)) < error


def picture(seed: int, samples: int, context: Context) -> Floats:
    renderer = Renderer(ROOM, settings_for(WANTED, samples=samples), context, seed=seed)
    radiance = renderer.render().image().radiance.astype(np.float64)
    renderer.release()
    return radiance


def test_half_as_many_samples_must_suffice(context: Context) -> None:
    """No denoised picture is tried against a plain one of 96 samples; one is against 128."""
    assert denoised_choice(ROOM, chosen(96 * 0.5**2), 0.5, context) is None
    found = denoised_choice(ROOM, chosen(128 * 0.5**2), 0.5, context)
    assert found
    assert found.samples == 64


@pytest.mark.slow
def test_what_longer_paths_leave_out_counts(context: Context) -> None:
    """The bias leaves no room for the filter's error."""
    found = denoised_choice(ROOM, chosen(8.0), 0.06, context)
    assert found
    bias = 0.95 * 0.06  # it leaves 1.9 % for noise, or 8,200 samples of a plain picture
    other = denoised_choice(ROOM, chosen(3.0, bias), 0.06, context)
    assert other is None or other.samples > found.samples


@pytest.mark.slow
def test_a_large_picture_is_measured_small(context: Context) -> None:
    large = settings_for(WANTED, width=1920, height=1080, bounces=1)
    found = denoised_choice(ROOM, replace(chosen(128 * 0.5**2), settings=large), 0.5, context)
    assert found
    assert found.size == (MOST_PIXELS, round(MOST_PIXELS * 1080 / 1920))


def test_words_name_samples_of_both_and_what_to_add() -> None:
    nothing = np.zeros((4, 4, 3))
    reference = Reference(nothing, nothing, 0, 6)
    verdict = Verdict(0.04, reference, (chosen(8.0),), {})
    told = denoised_advice(verdict, DenoisedChoice("nlm", 128, 0.031, 0.035, (96, 96)))
    for words in ("128 samples", "5,008", "3.1 %", "below 3.5 %", "--denoise nlm --samples 128"):
        assert words in told
