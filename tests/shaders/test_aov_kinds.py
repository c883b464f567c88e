"""Every AOV has a number, a value, colours and a title: none falls back to that of another."""

import re
from typing import get_args

import pytest

from glrt.gpu.glsl import read
from glrt.rendering.passes import AOV_NUMBERS, aov_pass
from glrt.settings import OF_PATHS, TERMS, Aov
from glrt.view.viewport.views import TITLES, VIEWS

FILES = ("integrators/first_hit.glsl", "aov_view.frag")


def test_every_aov_has_a_number_of_its_own() -> None:
    names = [aov.upper() for aov in get_args(Aov)]
    assert set(AOV_NUMBERS) == {"NO_AOV", *names}
    assert len(set(AOV_NUMBERS.values())) == len(AOV_NUMBERS)


@pytest.mark.parametrize("file", FILES)
@pytest.mark.parametrize("aov", get_args(Aov))
def test_every_aov_is_named_where_one_is_distinguished_from_the_others(aov: Aov, file: str) -> None:
    if aov in TERMS and file == "aov_view.frag":  # it shows all of them as the picture
        assert AOV_NUMBERS["EMISSION"] <= AOV_NUMBERS[aov.upper()] <= AOV_NUMBERS["VOLUME"]
    elif aov in TERMS:
        place = AOV_NUMBERS[aov.upper()] - AOV_NUMBERS["EMISSION"]
        assert aov_pass((aov,)).constants["LIGHT_TERMS"] == 1 << place
    elif aov in OF_PATHS and file != "aov_view.frag":  # its pass traces whole paths
        assert aov_pass((aov,)).constants[f"COUNT_{aov.upper()}"] is True
    else:
        assert re.search(rf"== {aov.upper()}\b", read(file))


def test_every_aov_is_a_view_with_a_title() -> None:
    assert set(get_args(Aov)) <= set(VIEWS)
    assert set(get_args(Aov)) <= TITLES.keys()
