"""Export: what was typed becomes a command, or is refused with its name."""

import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.core.resources import folder
from glrt.image.sources import STRICT, load, load_recipe
from glrt.settings import Settings, settings_for
from glrt.view.boxes.export_box import keep_shape
from glrt.view.export.clipboard import command_for
from glrt.view.export.jobs import Job
from glrt.view.export.sources import write_source
from glrt.view.export.wishes import Wish, check_place, order_of

WISH = Wish(picture="a.png", film="a.webp")


def no_words(_: Path) -> list[str]:
    return []


def options(**changes: Any) -> str:
    return " ".join(order_of(replace(WISH, **changes), Settings()).options)


def test_a_picture_is_ordered_by_its_options() -> None:
    rest = "--denoise none --caustics off"
    assert options() == f"--width 512 --height 512 --samples 256 {rest}"
    assert options(until="error", error="3%") == f"--width 512 --height 512 --error 0.03 {rest}"
    assert options(until="error", error=" 0.5 ").split()[5] == "0.5"


def test_a_film_is_ordered_by_its_frames() -> None:
    assert options(kind="film").endswith("--fps 24 --turntable 48")
    assert options(kind="film", motion="animation", rate="12.5").endswith("off --fps 12.5")


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        *(({"width": text}, "width") for text in ("", "0", "16385", "1e2", "-1", "²", "9" * 5000)),
        ({"height": "100000"}, "height"),
        ({"samples": "1048577"}, "samples"),
        *(({"until": "error", "error": text}, "error") for text in ("0", "nan", "101 %", "a", "")),
        *(({"kind": "film", "rate": text}, "frames a second") for text in ("0", "inf", "x")),
        ({"kind": "film", "frames": "0"}, "frames"),
        ({"denoise": "auto", "samples": "63"}, "denoise: it needs 64"),
        ({"picture": ""}, "no name"),
        ({"picture": "a.bmp"}, ".png, .exr"),
        ({"kind": "film", "film": "a.avi"}, ".webp"),
    ],
)
def test_a_wrong_value_is_refused_by_its_name(changes: dict[str, Any], named: str) -> None:
    with pytest.raises(UsageError, match=named):
        options(**changes)


def test_a_place_that_cannot_be_written_is_refused_before_anything_is_rendered(
    tmp_path: Path,
) -> None:
    missing = str(tmp_path / "missing" / "a")
    picture = order_of(replace(WISH, picture=f"{missing}.png"), Settings())
    film = order_of(replace(WISH, kind="film", film=f"{missing}.webp"), Settings())
    for order in (picture, film):
        with pytest.raises(UsageError, match="missing"):
            check_place(order)
    check_place(order_of(replace(WISH, picture=str(tmp_path / "a.jpg")), Settings()))
    assert list(tmp_path.iterdir()) == []


def test_one_side_follows_the_other() -> None:
    wish = replace(WISH, width="1000")
    keep_shape(wish, ("512", "512"), (200, 100))
    assert (wish.width, wish.height) == ("1000", "500")
    wish.height = "10"
    keep_shape(wish, ("1000", "500"), (200, 100))
    assert (wish.width, wish.height) == ("20", "10")
    wish.width = "wide"
    keep_shape(wish, ("20", "10"), (200, 100))
    assert (wish.width, wish.height) == ("wide", "10")


def test_the_view_is_written_with_all_that_renders_it_again(tmp_path: Path) -> None:
    scene = load("painted")
    settings = settings_for(scene.render, width=33, exposure=1.5, seed=7)
    base = folder("scenes")
    named, *rest = write_source(tmp_path, scene, settings, base, STRICT)
    assert rest == ["--assets-from", str(base)]
    assert [file.name for file in tmp_path.iterdir()] == [Path(named).name]
    found, recipe = load_recipe(named, STRICT._replace(folder=base))
    assert (found, recipe) == (scene, settings)


def test_files_from_elsewhere_are_copied_next_to_the_view(tmp_path: Path) -> None:
    scene = load("painted")
    for base in (None, tmp_path / "no"):
        folder_of_view = tmp_path / str(base is None)
        folder_of_view.mkdir()
        named, *rest = write_source(folder_of_view, scene, settings_for(scene.render), base, STRICT)
        assert rest == []
        assert load_recipe(named)[0] == scene


def test_a_caution_of_the_command_is_reported_with_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Such as one about a film whose camera goes through a wall."""
    says = "import sys; print('glrt: caution: frames 1-3: all is black.', file=sys.stderr)"
    monkeypatch.setattr("glrt.view.export.jobs._GLRT", (sys.executable, "-c", says))
    job = Job(
        order_of(replace(WISH, kind="film", film=str(tmp_path / "a.webp")), Settings()), no_words
    )
    deadline = time.monotonic() + 60
    while not job.is_over and time.monotonic() < deadline:
        time.sleep(0.01)
    assert (job.problem, job.note) == ("", "Frames 1-3: all is black.")


def test_the_program_of_the_desktop_is_chosen_or_named() -> None:
    x11, both = {"DISPLAY": ":1"}, {"DISPLAY": ":1", "WAYLAND_DISPLAY": "wayland-0"}

    def having(*names: str) -> Any:
        return lambda name: f"/usr/bin/{name}" if name in names else None

    assert command_for(x11, having("xclip", "wl-copy"))[0] == "xclip"
    assert command_for(both, having("xclip", "wl-copy"))[0] == "wl-copy"
    assert command_for(both, having("xclip"))[0] == "xclip", "by XWayland"
    with pytest.raises(UsageError, match="install wl-clipboard"):
        command_for(both, having())
    with pytest.raises(UsageError, match="install xclip"):
        command_for(x11, having("wl-copy"))
    with pytest.raises(UsageError, match="alone"):
        command_for({}, having("xclip"))
