"""Transfer functions: as files and as arrays, their bounds, and their rows in the kernel."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.image.sources import load
from glrt.packing.media import knots_of, medium_row, pack_media
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.scene.animation.tracks import parse_target
from glrt.scene.frames import with_values
from glrt.scene.grids import steps_across
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.settings import settings_for
from tests.support.builders import box, scene_of
from tests.support.media import filled

KNOTS: dict[str, Any] = {
    "values": np.array([0.0, 0.5, 0.5, 2.0]),
    "colors": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [4, 4, 4]],
    "opacities": [0.0, 0.9, 0.2, 0.6],
    "length": 0.25,
}
COLORS = [[1, 2, 3], [3, 2, 1], [4, 4, 4], [1, 1, 2]]
VALUES = np.random.default_rng(1).uniform(0, 2, (20, 9, 17)).astype(np.float32)


def scanned(**changes: Any) -> Scene:
    """Even fog between two scans."""
    transfer = glrt.Transfer(**{**KNOTS, **changes})
    scan = glrt.Medium(density=glrt.Density(VALUES), transfer=transfer)
    media = {"first": scan, "fog": glrt.Medium(absorption=(1, 1, 1)), "last": scan}
    things = [
        filled(box([3 * k, 0, 0], [3 * k + 1, 1, 1], ""), name) for k, name in enumerate(media)
    ]
    return scene_of(things, {}, media=media, background={"color": [1, 1, 1]})


# --- what is lost ----------------------------------------------------------------------------


def test_the_extinction_of_a_range_of_densities_is_that_of_its_densest() -> None:
    """A knot within counts, on either side of a step; nothing lies beyond the ends."""
    transfer = glrt.Transfer(**KNOTS)
    draw = np.random.default_rng(3)
    low = draw.uniform(-0.5, 2.5, 200)
    high = low + draw.exponential(0.3, 200)
    tried = np.linspace(low, high, 2001)
    opacity = np.interp(tried, KNOTS["values"], KNOTS["opacities"])
    most = (-np.log1p(-opacity) / 0.25).max(axis=0)
    found = transfer.extinction(low, high)
    assert (found >= most * (1 - 1e-12)).all()
    is_over_a_step = (low <= 0.5) & (high >= 0.5)
    assert_allclose(found[is_over_a_step], -np.log(0.1) / 0.25)
    assert_allclose(found[~is_over_a_step], most[~is_over_a_step], rtol=1e-3)


def test_the_smallest_density_of_a_brick_is_that_of_its_voxels() -> None:
    """Bricks have 8 voxels along an edge, and a density between voxels depends on both."""
    grid = glrt.Density(VALUES).file
    assert grid.voxels is not None
    assert grid.bottoms.shape == grid.tops.shape == (3, 2, 3)
    assert grid.bottoms[1, 1, 2] == grid.voxels[7:17, 7:, 15:].min()
    assert grid.tops[1, 1, 2] == grid.voxels[7:17, 7:, 15:].max()


def test_a_ray_takes_more_steps_through_what_is_denser() -> None:
    thin, thick = (scanned(length=length) for length in (0.5, 0.005))
    assert steps_across(thick, "first") > 5 * steps_across(thin, "first")


# --- rows ------------------------------------------------------------------------------------


def test_knots_follow_their_medium() -> None:
    facts = SceneFacts(scanned().model_copy(update={"lights": {"media.last": 0.5}}))
    rows = pack_media(facts)["Medium"]
    assert [medium_row(facts, it) for it in facts.media.rows] == [0, 5, 6]
    assert medium_row(facts, None) == -1
    assert [knots_of(facts, name) for name in facts.media.names] == [4, 0, 4]
    assert_allclose(rows["emission"][7:, 0], KNOTS["values"])
    assert_allclose(rows["emission"][7:, 1], KNOTS["opacities"], rtol=1e-7)
    assert_allclose(rows["scattering"][7:], 0.5 * np.array(KNOTS["colors"]))
    assert_allclose(rows["extinction"][6], [4, 0.25, 0])
    assert_allclose(rows["extinction"][5], 1)
    assert pack_media(facts)["Boundary"]["inside"].tolist() == [0, 5, 6]


def test_an_opacity_that_rounds_to_1_does_not_end_all_light() -> None:
    facts = SceneFacts(scanned(opacities=[1 - 1e-12] * 4))
    assert (pack_media(facts)["Medium"]["emission"][1:5, 1] < 1).all()


# --- light, files ----------------------------------------------------------------------------


def test_its_light_is_relit_as_a_whole_alone() -> None:
    """The media first and last have a light group each."""
    scene = scanned(colors=COLORS)
    film = prepare(scene, settings_for(scene.render), layering="groups")
    assert scene.light_groups.keys() == {"media.first", "media.last", "background"}
    twice = scanned(colors=(2 * np.array(COLORS)).tolist())
    dimmed = scene.model_copy(update={"lights": {"media.first": 2.0, "media.last": 2.0}})
    for other in (twice, dimmed):
        relit = film.relit(other, film.settings, "groups")
        assert relit is not None
        assert relit.weights == ((2.0, 2.0, 2.0), (2.0, 2.0, 2.0), (1.0, 1.0, 1.0))
    one = scanned(colors=[[2, 2, 3], *COLORS[1:]])
    fewer = scanned(values=[0, 0.5, 1], colors=COLORS[:3], opacities=[0, 0.9, 0.2])
    for other in (one, fewer, scanned(colors=COLORS, opacities=[0.1] * 4)):
        assert film.relit(other, film.settings, "groups") is None


def test_a_scan_is_read_as_it_was_written(tmp_path: Path) -> None:
    write_scene(scanned(), tmp_path / "a.toml")
    again = load(tmp_path / "a.toml")
    assert again.media["first"].transfer == glrt.Transfer(**KNOTS)
    assert again.media == scanned().media


def test_a_medium_is_of_one_kind() -> None:
    scan: Any = {"density": glrt.Density(VALUES), "transfer": glrt.Transfer(**KNOTS)}
    with pytest.raises(ValueError, match="place of absorption"):
        glrt.Medium(**scan, absorption=(0, 0, 1))
    with pytest.raises(ValueError, match="needs density"):
        glrt.Medium(transfer=scan["transfer"])


# --- values that change ----------------------------------------------------------------------


def test_tables_of_a_medium_change_from_frame_to_frame() -> None:
    scene = scanned()
    values = {
        parse_target("media.first.density.scale"): 3.0,
        parse_target("media.last.transfer.length"): 0.5,
    }
    found = with_values(scene, values, "a").media
    density, transfer = found["first"].density, found["last"].transfer
    assert density is not None
    assert transfer is not None
    assert (density.scale, density.file.is_read) == (3.0, True)
    assert transfer == glrt.Transfer(**{**KNOTS, "length": 0.5})
    assert found["first"].transfer == scene.media["first"].transfer


@pytest.mark.parametrize(
    ("target", "value", "says"),
    [
        ("media.first.density.scale", -1.0, "a: media.first.density: scale must be at least 0"),
        ("media.first.density.scal", 1.0, "unknown key 'scal'"),
        ("media.fog.density.scale", 1.0, "medium 'fog' has no density"),
    ],
)
def test_a_table_that_cannot_change_so_is_refused(target: str, value: float, says: str) -> None:
    with pytest.raises(SceneError, match=re.escape(says)):
        with_values(scanned(), {parse_target(target): value}, "a")


def test_a_table_of_a_medium_is_no_value_itself() -> None:
    with pytest.raises(ValueError, match="names no value that can change"):
        parse_target("media.first.density")
