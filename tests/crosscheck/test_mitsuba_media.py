"""Fog and milk look the same to Mitsuba 3, which follows light through them by `volpathmis`."""

from typing import Any

import pytest

from bench.peer import Peer
from glrt.gpu.context import Context
from tests.crosscheck.test_mitsuba import judged, ours, theirs
from tests.mitsuba.media import SCENES


def turned(fog: Any) -> Any:
    """Light turns the other way."""
    return {**fog, "anisotropy": -fog["anisotropy"]}


def denser(fog: Any) -> Any:
    """A tenth more light is scattered."""
    return {**fog, "scattering": [1.1 * x for x in fog["scattering"]]}


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_media_look_the_same_to_mitsuba(context: Context, mitsuba: Peer, name: str) -> None:
    make, fog, bounces = SCENES[name]
    picture = theirs(mitsuba, make(fog), 1024, bounces=bounces)
    found = judged(ours(context, make(fog), 1024, bounces=bounces), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    for wrong in (turned, denser):
        other = judged(ours(context, make(wrong(fog)), 1024, bounces=bounces), picture)
        assert not other, f"{wrong.__doc__} {other}"
