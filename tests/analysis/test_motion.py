"""The chart of error while something moves: its frames, its figures, its files."""

import csv
import math
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

from glrt.analysis.chart.rays import rays_of
from glrt.analysis.motion.measure import (
    BEFORE,
    FRAMES,
    Seen,
    Track,
    TrackPlan,
    by_probes,
    looks_of,
    tracks_of,
)
from glrt.analysis.motion.playing import Played, play
from glrt.analysis.motion.report import HEADINGS, PAGE, rows, save_page, save_tracks
from glrt.analysis.motion.sequences import light_step, orbit, turned
from glrt.analysis.plot import MOST_CURVES
from glrt.cli.commands import run
from glrt.cli.moving_options import ways_of
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history.temporal import WAYS, Mode, Way
from glrt.rendering.probe_tracer import LOOKS, PUSHED, UPDATES
from glrt.settings import Settings, settings_for
from tests.rendering.test_live_probes import warmed_up
from tests.truths.test_probes import room


def test_an_orbit_keeps_its_distance_and_goes_to_and_fro() -> None:
    scene = load("cornell")
    frames = orbit(scene, 32, 1.0).scenes
    places = np.array([frame.camera.position for frame in frames])
    middle = np.array(scene.camera.look_at)
    distances = np.linalg.norm(places - middle, axis=1)
    np.testing.assert_allclose(distances, distances[0])
    assert tuple(places[0]) == pytest.approx(scene.camera.position)
    flat = (places - middle)[:, [0, 2]]
    cosines = (flat[1:] * flat[:-1]).sum(axis=1) / np.linalg.norm(flat[0]) ** 2
    np.testing.assert_allclose(np.degrees(np.arccos(cosines)), 1.0, rtol=1e-6)
    angles = np.degrees(np.arctan2(flat[:, 0], flat[:, 1]))
    assert angles.max() - angles.min() == pytest.approx(16, abs=1e-6)
    assert {frame.camera.look_at for frame in frames} == {scene.camera.look_at}


def test_a_quarter_turn_is_one() -> None:
    camera = load("cornell").camera.model_copy(
        update={"position": (0.0, 1.0, 2.0), "look_at": (0.0, 0.0, 0.0)}
    )
    assert turned(camera, math.pi / 2).position == pytest.approx((2.0, 1.0, 0.0))


def test_a_light_step_changes_all_groups_once() -> None:
    scene = load("lamps")
    frames = light_step(scene, 8, 3, 0.25).scenes
    assert frames[:3] == (scene,) * 3
    assert len({id(frame) for frame in frames[3:]}) == 1
    assert frames[3].lights == dict.fromkeys(("amber", "blue", "rose"), 0.25)
    assert frames[3].camera == scene.camera


@pytest.mark.parametrize("name", ["orbit", "light step"])
def test_looks_are_frames_of_the_sequence(name: str) -> None:
    scene = load("cornell")
    frames = (
        orbit(scene, FRAMES, 1.0) if name == "orbit" else light_step(scene, FRAMES, BEFORE, 0.5)
    )
    looks = looks_of(frames)
    assert looks == sorted(set(looks))
    assert looks[0] == (0 if name == "orbit" else BEFORE)
    assert looks[-1] < FRAMES


@pytest.mark.slow
def test_history_makes_an_orbit_clearer_and_figures_are_the_same_again(context: Context) -> None:
    """At 24 x 24 pixels it is more than twice as clear after some frames."""
    scene = load("cornell")
    settings = settings_for(scene.render, width=24, height=24)
    modes: tuple[Mode, ...] = ("reset", "reproject")
    plan = TrackPlan([*map(Way, modes)], (), 256)
    found = [
        tracks_of("cornell", scene, settings, context, plan, lambda *_: None) for _ in range(2)
    ]
    assert found[0] == found[1]
    reset, reproject = found[0][:2]
    assert [track.mode for track in found[0]] == [*modes, *modes]
    assert reset.seen[0].squared_error == reproject.seen[0].squared_error  # no history yet
    assert reproject.seen[0].rays == reset.seen[0].rays + 1
    late = [sum(one.squared_error for one in t.seen[5:]) for t in (reset, reproject)]
    assert late[0] > 4 * late[1]


SHARES: dict[Mode, float] = {"reset": 1.0, "reproject": 0.25}
TRACKS = [
    Track("room", sequence, mode, (Seen(1, 5.0, 1.0), Seen(2, 6.0, scale), Seen(3, 6.0, -1e-9)))
    for sequence in ("orbit", "light step")
    for mode, scale in SHARES.items()
]


@pytest.mark.slow
def test_files_hold_the_figures(tmp_path: Path) -> None:
    save_tracks("room", "A room", TRACKS, tmp_path)
    table = [*csv.reader((tmp_path / "room.temporal.csv").read_text().splitlines())]
    assert table[0] == list(HEADINGS)
    assert len(table) == 1 + 12
    assert table[5] == ["room", "orbit", "reproject", "2", "6.0", "0.5"]
    assert [*rows(TRACKS)][2][-1] == "0"
    for suffix in (".svg", ".png"):
        assert (tmp_path / f"room.temporal{suffix}").stat().st_size > 1000
    page = save_page(TRACKS, "Small.", tmp_path).read_text()
    assert "| room | orbit, 1 degree a frame | reproject | 5.7 | 0.500 | 1.33 |" in page


def test_the_command_refuses_modes_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(
        UsageError, match="--temporal takes reset, reproject, taa, ataa, wrls, upsample; got 'blur'"
    ):
        run(["chart", "cornell", "-o", str(tmp_path), "--temporal", "reset,blur"])


def test_the_command_refuses_predictors_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--predictor takes published, delayed; got 'none'"):
        run(["chart", "cornell", "-o", str(tmp_path), "--temporal", "wrls", "--predictor", "none"])


def test_wrls_is_charted_by_each_predictor() -> None:
    arguments = Namespace(
        temporal="reset,wrls,reset", predictor="published,delayed", traced="8", factor="4"
    )
    assert [way.name for way in ways_of(arguments)] == ["reset", "wrls", "wrls delayed"]
    assert {name: way.predictor for name, way in WAYS.items()} == {
        **dict.fromkeys(("reset", "reproject", "taa", "ataa", "wrls"), "published"),
        **dict.fromkeys(("upsample", "upsample 2", "upsample 8"), "published"),
        "wrls delayed": "delayed",
    }


def test_ataa_is_charted_by_each_number_of_samples() -> None:
    arguments = Namespace(temporal="taa,ataa", predictor="published", traced="2,8,16", factor="4")
    first, *ways = ways_of(arguments)
    assert first.mode == "taa"
    assert [(way.name, way.traced) for way in ways] == [("ataa 2", 2), ("ataa", 8), ("ataa 16", 16)]


def test_the_command_refuses_numbers_of_samples_that_ataa_does_not_take(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"--traced takes 2, 3, .*, 16; got '17'"):
        run(["chart", "cornell", "-o", str(tmp_path), "--temporal", "ataa", "--traced", "2,17"])


def test_ataa_traces_as_many_samples_as_are_asked_for(context: Context) -> None:
    """More of each pixel of a mask that is found by the same samples of the film."""
    scene = load("cornell")
    settings = settings_for(scene.render, width=24, height=24, bounces=2, sampler="independent")
    taken = []
    for traced in (2, 16):
        more: list[float] = []
        frames = orbit(scene, 4, 1.0)
        assert [*play(frames, Played(settings, Way("ataa", traced=traced)), context, 1, more)]
        taken.append(more[1])
    assert 0 < taken[0] < 2
    assert taken[1] == 8 * taken[0]


@pytest.mark.slow
def test_the_command_writes_charts_and_a_page(tmp_path: Path) -> None:
    words = ["chart", "cornell", "-o", str(tmp_path), "--temporal", "reset,reproject"]
    words += ["--milliseconds", "--rounds", "2"]
    assert run([*words, "--height", "16", "--quiet"]) == 0
    [head, *lines] = (tmp_path / "cornell.temporal.csv").read_text().splitlines()
    assert head.endswith(",error,milliseconds")
    assert min(float(line.rpartition(",")[2]) for line in lines) > 0
    assert {file.name for file in tmp_path.iterdir()} == {
        PAGE,
        *(f"cornell.temporal.{suffix}" for suffix in ("svg", "png", "csv")),
    }


def test_live_probes_follow_a_light_step_frame_by_frame(context: Context) -> None:
    """A closed room shines with 1, then with 1/4: an update keeps a share, and adds the rest."""
    scene, kept, dim = room("sphere", 0.5), 0.9, 0.25
    frames = light_step(scene, 8, 3, dim)
    way = {"width": 8, "height": 8, "method": "ddgi", "sampler": "sobol", "probes": 2}
    settings = settings_for(scene.render, **way, bounces=3, roulette=False)
    held = warmed_up(0.5)
    for number, picture in enumerate(play(frames, Played(settings, Way("reset"), kept), context)):
        shines = 1.0 if number < 3 else dim
        if number:
            held = kept * held + (1 - kept) * 0.5 * (shines + held)
        np.testing.assert_allclose(picture, shines + 0.5 * (shines + held), rtol=1e-3)


@pytest.mark.slow
def test_tracks_of_probes_count_their_rays(context: Context) -> None:
    """Live probes take an update a frame, and are placed again only in an orbit."""
    scene = load("methods/diffuse")
    settings = settings_for(scene.render, width=16, height=16, probes=2)
    plan = TrackPlan([Way("reset")], (0.9,), 16)
    found = tracks_of("d", scene, settings, context, plan, lambda *_: None)
    names = ["reset", "ddgi", "ddgi, live 0.9"]
    assert [track.mode for track in found] == [*names, *names]
    of_ddgi = rays_of(scene, found_settings(settings), context)
    own, live, still = found[1].seen, found[2].seen, found[5].seen
    everything = of_ddgi.sample + of_ddgi.set + of_ddgi.once
    assert {one.rays for one in own} == {everything}
    assert live[0].rays == everything
    update = of_ddgi.sample + of_ddgi.set / UPDATES
    looks = of_ddgi.once / (PUSHED + 1 + LOOKS)
    assert live[1].rays == pytest.approx(update + looks * (1 + PUSHED + 1))
    assert still[1].rays == pytest.approx(update + looks)


def found_settings(settings: Settings) -> Settings:
    return by_probes(settings, (0.9,))["ddgi"].settings


@pytest.mark.parametrize("given", ["1", "-0.1", "much", "0.9,,0.8"])
def test_the_command_refuses_what_probes_cannot_keep(tmp_path: Path, given: str) -> None:
    with pytest.raises(UsageError, match="--hysteresis takes shares from 0 to below 1"):
        run(["chart", "cornell", "-o", str(tmp_path), "--temporal", "reset", "--hysteresis", given])


def test_live_probes_are_charted_where_something_moves(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="give --temporal"):
        run(["chart", "cornell", "-o", str(tmp_path), "--hysteresis", "0.9"])


def test_more_curves_than_a_chart_distinguishes_are_refused(tmp_path: Path) -> None:
    shares = ",".join(f"0.{number}" for number in range(1, MOST_CURVES))
    words = ["--temporal", "reset,taa", "--hysteresis", shares]
    with pytest.raises(UsageError, match="choose fewer"):
        run(["chart", "cornell", "-o", str(tmp_path), *words])
