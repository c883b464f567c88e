"""Metals by a colour, a name or an index of refraction: one way, checked, saved and read again."""

from pathlib import Path
from typing import Any

import pytest

import glrt
from glrt.cli.main import main

ONE = (1.0, 1.0, 1.0)
SCENE = """
[camera]
position = [0, 0, 3]
look_at = [0, 0, 0]
[background]
color = [1, 1, 1]
[materials.m]
type = "metal"
{way}
[[objects]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "m"
"""
WRONG = {
    "": "materials.m must say what it reflects in one way: by color, by preset, or by ior and k",
    'preset = "gold"\ncolor = [1, 1, 1]': "materials.m must say what it reflects in one way",
    "ior = [1, 1, 1]": "materials.m must say what it reflects in one way",
    "k = [1, 1, 1]": "materials.m must say what it reflects in one way",
    'preset = "golf"': "unknown preset 'golf'; did you mean 'gold'?",
    "ior = [1, 1, 1]\nk = [1, -1, 1]": "materials.m.k[1] must be at least 0, got -1",
    "ior = [0, 1, 1]\nk = [1, 1, 1]": "materials.m.ior[0] must be at least 0.001, got 0",
}


@pytest.mark.parametrize("way", WRONG)
def test_metal_that_says_less_or_more_is_refused(
    way: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(SCENE.format(way=way))
    assert main(["render", str(file), "-o", str(tmp_path / "a.png")]) == 2
    assert WRONG[way] in capsys.readouterr().err
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    "way", [{"color": ONE}, {"preset": "iron"}, {"ior": (0.5, 1.0, 2.0), "k": (3.0, 2.0, 1.0)}]
)
def test_each_way_is_saved_and_read_again(way: dict[str, Any], tmp_path: Path) -> None:
    scene = glrt.Scene.build(
        {"position": [0, 0, 3], "look_at": [0, 0, 0]},
        [glrt.Sphere(center=(0, 0, 0), radius=1, material="m")],
        materials={"m": glrt.Metal(roughness=0.2, **way)},
        background={"color": ONE},
    )
    scene.save(tmp_path / "scene.toml")
    assert glrt.load(tmp_path / "scene.toml") == scene
    assert set(scene.materials["m"].model_dump(exclude_none=True)) >= {*way, "roughness"}


def test_what_is_reflected_head_on() -> None:
    """Mirrors of glass: ((n - 1) / (n + 1))^2."""
    assert glrt.Metal(color=(0.1, 0.2, 0.3)).head_on == (0.1, 0.2, 0.3)
    assert glrt.Metal(ior=(1.5,) * 3, k=(0,) * 3).head_on == pytest.approx((0.04,) * 3)
