"""Two ways to render at once: the law of one under the other, and the laws of special pairs."""

from collections.abc import Callable

import numpy as np
import pytest

from glrt import Renderer, load, merge
from glrt.cli.commands import run
from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.plan.combinations import Way
from tests.support.renders import same
from tests.support.ways import (
    ALONE,
    BASES,
    LAWS,
    OPTIONS,
    SIZE,
    Options,
    blurred,
    parts,
    plain,
    rendered,
    save_moving,
)


def try_together(one: Way, other: Way) -> None:
    """The law of one under the other."""
    if special := SPECIAL.get(frozenset({one, other})):
        return special()
    for way, more in ((one, other), (other, one)):
        if way in BASES:
            return LAWS[more](BASES[way])
        if way in ALONE:
            return ALONE[way](OPTIONS[more])
    if one is Way.AUTO and other is Way.TIME:
        return LAWS[Way.AUTO](lambda options: plain([*timed(options), *options]))
    if {one, other} == {Way.TIME, Way.ERROR}:
        return LAWS[Way.ERROR](lambda options: plain([*timed(options), *options]))
    return LAWS[other](lambda options: plain([*OPTIONS[one], *options]))


def timed(options: Options) -> Options:
    """A limit of time that is not reached, unless the samples are given."""
    return [] if "--samples" in options else ["--time", "1e6"]


def part_of_a_merged_picture() -> None:
    whole = parts([])
    merge(whole).save("merged.exr")
    assert same(rendered("merged.exr", "--part", "2/3"), whole[1])


def resume_a_part() -> None:
    whole = parts([])[1]
    size = {"width": 16, "height": 12, "bounces": 4, "samples": 60}
    renderer = Renderer(load("cornell"), part=(2, 3), tier="complete", **size)  # type: ignore[arg-type]
    renderer.render(5).image().save("begun.exr")
    renderer.release()
    assert same(rendered("--resume", "begun.exr"), whole)


def resume_adaptive() -> None:
    """Beyond the floor, where counts differ."""
    options = OPTIONS[Way.ADAPTIVE]
    plain([*options, "--samples", "100"]).save("begun.exr")
    whole = plain([*options, "--samples", "160"])
    found = rendered("--resume", "begun.exr", "--samples", "160")
    assert same(found, whole)
    assert np.ptp(found.counts)


def resume_reuse() -> None:
    """Whole blocks of 16 samples go on; others lack the points that samples share."""
    options = OPTIONS[Way.REUSE]
    plain([*options, "--samples", "24"]).save("half.exr")
    with pytest.raises(UsageError, match=r"half\.exr.*ends within a block of 16 samples"):
        run(["render", "--resume", "half.exr", "--samples", "64", "-o", "never.exr"])
    plain([*options, "--samples", "32"]).save("half.exr")
    assert same(rendered("--resume", "half.exr", "--samples", "64"), plain(options))


def resume_denoised() -> None:
    """The halves are those of one render, up to the rounding of float32."""
    whole = plain([*OPTIONS[Way.DENOISE], "--samples", "128"])
    plain(OPTIONS[Way.DENOISE]).save("half.exr")
    found = rendered("--resume", "half.exr", "--samples", "128")
    assert same(found, whole)
    np.testing.assert_allclose(found.shown, whole.shown, rtol=1e-3, atol=1e-4)
    assert found.error_to_reach == pytest.approx(whole.error_to_reach, rel=1e-2)


def denoised_in_time() -> None:
    """The picture is the plain one if it has fewer samples than denoising needs."""
    options = [*OPTIONS[Way.DENOISE], *OPTIONS[Way.TIME]]
    image = plain(options)
    assert (image.denoising is None) == (image.samples < 64)
    assert same(image, plain(["--samples", str(image.samples)]))


def hybrid_with_probes() -> None:
    """With all effects it is the picture of ddgi, to the bit."""
    probes = OPTIONS[Way.PROBES]
    assert same(plain([*probes, "--method", "hybrid"]), plain(probes))


def resume_blurred() -> None:
    """Times follow from the numbers of samples alone."""
    whole = blurred([])
    blurred(["--samples", "24"]).save("half.exr")
    assert same(rendered("--resume", "half.exr", "--samples", "64"), whole)


def blurred_parts() -> list[Image]:
    words = [*save_moving(), "--samples", "60"]
    images = [rendered(*words, "--part", f"{k}/3") for k in (1, 2, 3)]
    whole, found = blurred(["--samples", "60"]), merge(images)
    np.testing.assert_allclose(found.radiance, whole.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(found.stderr, whole.stderr, rtol=1e-3, atol=1e-6)
    return images


def parts_of_a_blurred_picture() -> None:
    assert len(blurred_parts()) == 3


def merged_and_blurred() -> None:
    """A merged picture, rendered again."""
    found = merge(blurred_parts())
    found.save("merged.exr")
    assert same(rendered("merged.exr"), found)


def pilot_on_a_cluster() -> None:
    """Particles that a pilot chooses are refused, since each worker would follow them all."""
    options, cluster = OPTIONS[Way.PILOT], OPTIONS[Way.CLUSTER]
    here = plain(options)
    assert here.recipe
    if here.recipe.settings.caustics == "off":
        assert same(plain([*options, *cluster]), here)
        return
    with pytest.raises(UsageError, match="--caustics auto chose particles"):
        plain([*options, *cluster])


def parts_of_shared() -> tuple[Image, Image]:
    """Parts of whole blocks of 256 samples, merged; and the picture in one piece."""
    words = ["cornell", *SIZE, "--samples", "768", *OPTIONS[Way.SHARED]]
    images = [rendered(*words, "--part", f"{k}/3") for k in (1, 2, 3)]
    whole, found = rendered(*words), merge(images)
    np.testing.assert_allclose(found.radiance, whole.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(found.stderr, whole.stderr, rtol=1e-3, atol=1e-6)
    return found, whole


def part_of_shared() -> None:
    parts_of_shared()


def merged_and_shared() -> None:
    """A merged picture, rendered again."""
    found, _ = parts_of_shared()
    found.save("merged.exr")
    assert same(rendered("merged.exr"), found)


SPECIAL: dict[frozenset[Way], Callable[[], None]] = {
    frozenset({Way.PILOT, Way.CLUSTER}): pilot_on_a_cluster,
    frozenset({Way.RESUME, Way.PART}): resume_a_part,
    frozenset({Way.PART, Way.SHARED}): part_of_shared,
    frozenset({Way.MERGED, Way.SHARED}): merged_and_shared,
    frozenset({Way.RESUME, Way.REUSE}): resume_reuse,
    frozenset({Way.RESUME, Way.ADAPTIVE}): resume_adaptive,
    frozenset({Way.RESUME, Way.DENOISE}): resume_denoised,
    frozenset({Way.DENOISE, Way.TIME}): denoised_in_time,
    frozenset({Way.MERGED, Way.PART}): part_of_a_merged_picture,
    frozenset({Way.PROBES, Way.HYBRID}): hybrid_with_probes,
    frozenset({Way.RESUME, Way.SHUTTER}): resume_blurred,
    frozenset({Way.PART, Way.SHUTTER}): parts_of_a_blurred_picture,
    frozenset({Way.MERGED, Way.SHUTTER}): merged_and_blurred,
}
