"""Which variants a chart compares: particles and links only where there is something for them."""

from typing import Any

import pytest

from glrt.analysis.variants import variants_of
from glrt.denoise import oidn
from glrt.image.sources import load
from glrt.plan.methods import CLASSIC
from glrt.scene.grids import edges_of_voxels
from glrt.settings import settings_for
from tests.support.builders import MATTE, glass, lamp, quad, scene_of, sphere

MIRROR: dict[str, Any] = {"type": "metal", "color": [0.9, 0.9, 0.9]}
WITH = {"mis, particles": ("on", 0.0), "mis, particles linked": ("on", 1.0)}


def found(material: dict[str, Any], *more: dict[str, Any]) -> dict[str, tuple[str, float]]:
    """The variants with particles of a ball: whether they are on, and the share of links."""
    things = [sphere([0, 0, -3], 1, "ball"), quad([-1, 3, -4], [2, 0, 0], [0, 0, 2], "lamp")]
    scene = scene_of([*things, *more], {"ball": material, "matte": MATTE, "lamp": lamp()})
    variants = variants_of(scene, settings_for(scene.render), ["mis"])
    settings = {variant.name: variant.settings for variant in variants}
    return {name: (it.caustics, it.linked) for name, it in settings.items() if "particles" in name}


@pytest.mark.parametrize("material", [glass(), MIRROR], ids=["glass", "a mirror"])
def test_particles_are_charted_with_links_and_without(material: dict[str, Any]) -> None:
    assert found(material) == WITH


@pytest.mark.parametrize(
    ("material", "more"),
    [
        ({**glass(), "thin": True}, []),
        (glass(), [sphere([0, 0, -3], 0.5, "matte")]),
    ],
    ids=["thin glass", "a ball in a ball"],
)
def test_links_are_left_out_where_no_sphere_has_them(
    material: dict[str, Any], more: list[dict[str, Any]]
) -> None:
    assert [*found(material, *more)] == ["mis, particles"]


def test_particles_are_left_out_where_nothing_bends_light() -> None:
    assert found(MATTE) == {}


def test_probes_are_charted_by_the_sampler_that_they_need() -> None:
    scene = load("methods/diffuse")
    for sampler, tail in (("independent", ", sobol"), ("sobol", "")):
        settings = settings_for(scene.render, sampler=sampler)
        found = {it.name: it.settings for it in variants_of(scene, settings)}
        for method in ("ddgi", "gather"):
            assert found[method + tail].sampler == "sobol"
            assert found[method + tail].method == method


@pytest.mark.parametrize(("has_oidn", "filters"), [(True, ["nlm", "oidn"]), (False, ["nlm"])])
def test_the_denoisers_that_are_installed_are_charted(
    has_oidn: bool, filters: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(oidn, "is_installed", lambda: has_oidn)
    scene = load("methods/white")
    variants = variants_of(scene, settings_for(scene.render), ["mis"])
    denoised = {v.name: v.settings.denoise for v in variants if v.settings.denoise != "none"}
    assert denoised == {f"mis, denoised by {name}": name for name in filters}


def test_steps_are_charted_in_two_lengths_where_there_is_a_grid() -> None:
    scene = load("smoke")
    found = {it.name: it.settings for it in variants_of(scene, settings_for(scene.render))}
    marched = {name: it.march_step for name, it in found.items() if it.method == "march"}
    assert list(marched) == ["march", "march, 8 times the step"]
    (edge,) = edges_of_voxels(scene, "smoke")
    assert [*marched.values()] == [0.0, pytest.approx(8 * edge)]
    plain = load("fog")
    names = [it.name for it in variants_of(plain, settings_for(plain.render))]
    assert not any("march" in name for name in names)


def test_methods_that_refuse_media_or_leave_them_out_are_not_charted_with_them() -> None:
    scene = load("fog")
    methods = {it.settings.method for it in variants_of(scene, settings_for(scene.render))}
    assert not methods & {"ddgi", "gather", "resampled", "hybrid", *CLASSIC}
    assert methods >= {"naive", "nee", "mis"}
