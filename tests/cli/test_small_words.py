"""Names of outputs and values in messages are what the user wrote."""

import tomllib

import pytest

from glrt.cli.main import main
from glrt.cli.options import once
from glrt.core.errors import SceneError
from glrt.scene.scenefile.toml import parse_scene
from tests.support.moving_ball import MOVING_BALL


def test_a_file_named_twice_is_written_once() -> None:
    assert once(["x.png", "./x.png", "y.exr", "x.png"]) == ["x.png", "y.exr"]
    assert once(["", "x.png"]) == ["", "x.png"]


def test_an_empty_name_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "cornell", "-o", ""]) == 2
    assert "-o has an empty name: name a file that ends in .exr" in capsys.readouterr().err


def test_a_number_with_a_point_is_shown_with_it() -> None:
    text = MOVING_BALL.replace("background", "render = { width = 320.0 }\nbackground", 1)
    with pytest.raises(SceneError, match=r"width must be a whole number, got 320\.0\."):
        parse_scene(tomllib.loads(text), "x")


@pytest.mark.parametrize("colors", ["[[0.8, 0.1, 0.1]]", "[0.1, 0.2, 0.3]"])
def test_a_checkerboard_has_two_colors(colors: str) -> None:
    text = MOVING_BALL.replace("[0.8, 0.1, 0.1]", f"{{ checker = {colors} }}", 1)
    with pytest.raises(SceneError, match=r"checker must be a list of two colors"):
        parse_scene(tomllib.loads(text), "x")
