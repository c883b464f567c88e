"""A method's omissions are reported where they count, and only there."""

from typing import Any

import pytest

from glrt.plan.facts import SceneFacts
from glrt.plan.methods import CLASSIC
from glrt.plan.omissions import omissions
from glrt.settings import settings_for
from tests.support.builders import MATTE, glass, lamp, plane, scene_of, sphere
from tests.support.processes import glrt
from tests.support.renders import METHODS

MATERIALS: dict[str, dict[str, Any]] = {
    "matte": MATTE,
    "mirror": {"type": "metal", "color": [1, 1, 1]},
    "rough": {"type": "metal", "color": [1, 1, 1], "roughness": 0.5},
    "glass": glass(),
    "lamp": lamp(),
}
BALL = sphere([0, 0, -3], 1, "matte")
LAMP = sphere([0, 3, -3], 1, "lamp")
SKY = {"background": {"color": [1, 1, 1]}}
LOCAL, TREES, ALL = {"phong", "blinn"}, {"whitted", "whitted_tree"}, set(CLASSIC)
FOLLOWING = {*TREES, "cook"}
INDIRECT = "no indirect light"


@pytest.mark.parametrize(
    ("objects", "more", "text", "methods"),
    [
        ([BALL, LAMP], {}, INDIRECT, ALL),
        ([LAMP], {}, INDIRECT, set()),
        ([BALL, LAMP], {}, "no shadows", LOCAL),
        ([BALL, LAMP], {}, "hard shadows: lamps are points", TREES),
        ([BALL], SKY, "hard shadows: lamps are points", set()),
        ([BALL, sphere([2, 0, -3], 1, "mirror")], SKY, "mirrors reflect nothing", LOCAL),
        ([BALL, sphere([2, 0, -3], 1, "rough")], SKY, "mirrors reflect nothing", set()),
        ([sphere([2, 0, -3], 1, "rough")], SKY, "rough metal is a mirror", TREES),
        ([sphere([2, 0, -3], 1, "glass")], SKY, "glass is black", LOCAL),
        (
            [BALL, LAMP, sphere([2, 0, -3], 1, "glass")],
            {},
            "no light over mirrors or through glass onto matte surfaces",
            FOLLOWING,
        ),
        ([BALL, plane([0, 9, 0], [0, 1, 0], "lamp")], {}, "plane lamps light nothing", ALL),
        ([BALL, plane([0, -1, 0], [0, 1, 0], "matte")], SKY, "nothing hides the sky", ALL),
        ([BALL], SKY, "nothing hides the sky", set()),
    ],
)
def test_an_omission_is_reported_of_the_methods_that_make_it(
    objects: list[dict[str, Any]], more: dict[str, Any], text: str, methods: set[str]
) -> None:
    scene = scene_of(objects, MATERIALS, **more)
    every = {method: settings_for(scene.render, method=method) for method in (*METHODS, *CLASSIC)}
    found = {
        method
        for method, settings in every.items()
        if text in omissions(SceneFacts(scene), settings)
    }
    assert found == methods


@pytest.mark.parametrize(
    ("method", "bounces", "light", "lit"),
    [
        ("ddgi", 1, "", ""),
        ("ddgi", 2, "indirect light", ""),
        ("gather", 2, "", ""),
        ("gather", 3, "light over three matte surfaces or more", " that light others"),
        ("resampled", 3, "light over three matte surfaces or more", " that light others"),
    ],
)
def test_what_probes_blur_is_distinguished_from_the_bounces_on_that_they_light(
    method: str, bounces: int, light: str, lit: str
) -> None:
    scene = scene_of([BALL, LAMP, sphere([2, 0, -3], 1, "glass")], MATERIALS)
    found = omissions(SceneFacts(scene), settings_for(scene.render, method=method, bounces=bounces))
    assert [told.split(" what is finer")[0] for told in found[:1]] == [f"of {light}"][: bool(light)]
    assert (
        found[1:]
        == [f"light over mirrors or through glass onto matte surfaces{lit}"][: bool(light)]
    )


def test_a_lens_is_reported_of_the_methods_without_one() -> None:
    scene = scene_of([BALL], MATERIALS, {"defocus_angle": 1.0}, **SKY)
    told = {
        method
        for method in CLASSIC
        if "everything is in focus"
        in omissions(SceneFacts(scene), settings_for(scene.render, method=method))
    }
    assert told == ALL - {"cook"}


@pytest.mark.slow
def test_commands_say_what_is_left_out(tmp_path: Any) -> None:
    size = ("--width", "8", "--height", "8", "--samples", "2")
    command = ("render", "cornell", "-o", tmp_path / "a.png", *size, "--method", "whitted")
    for option in ((), ("--json",)):
        done = glrt(*command, *option)
        assert done.returncode == 0
        assert "Method whitted leaves light out, which no estimated error contains: no" in (
            done.stderr
        )
    assert glrt(*command, "--quiet").stderr == ""
    assert "no indirect light" in glrt("inspect", "cornell", "--method", "cook").stdout
    assert "leaves light out" not in glrt("inspect", "cornell").stdout


@pytest.mark.parametrize(
    ("changes", "is_told"),
    [
        ({"unbiased": False}, True),
        ({}, False),
        ({"unbiased": False, "reuse": "none"}, False),
        ({"unbiased": False, "method": "gather"}, False),
    ],
)
def test_what_the_biased_form_of_reuse_lacks_is_reported(
    changes: dict[str, Any], is_told: bool
) -> None:
    scene = scene_of([BALL, LAMP], MATERIALS)
    found = omissions(
        SceneFacts(scene), settings_for(scene.render, **{"method": "resampled", **changes})
    )
    assert any("at contacts and edges" in told for told in found) == is_told
