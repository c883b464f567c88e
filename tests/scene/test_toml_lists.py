"""Objects that come and go in the text of a scene file, and the comments that go with them."""

from pathlib import Path

import pytest

from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import decode_scene
from glrt.view.controls import replaced
from tests.support.scene_texts import changed_lines, saved

THREE = """\
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]

[materials.a]
type = "light"
emission = [1, 1, 1]

# the first
[[objects]]
shape = "sphere"
name = "one"
center = [0, 0, 0]
radius = 1 # its size
material = "a"

# --- the others ---

# the second,
# in two lines
[[objects]] # second
shape = "sphere"
name = "two"
center = [0, 3, 0]
radius = 2
material = "a"

# the third
[[objects]]
shape = "sphere"
name = "three"
center = [0, 6, 0]
radius = 3
material = "a"
# the end
"""
PARTS = {  # the lines of each object with the comment above it, and the blank line behind it
    "one": (8, 16),
    "two": (18, 27),
    "three": (27, 34),
}


def without(*names: str) -> str:
    """The text without the lines of some objects."""
    gone = {number for name in names for number in range(*PARTS[name])}
    lines = THREE.splitlines(keepends=True)
    return "".join(line for number, line in enumerate(lines) if number not in gone)


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
@pytest.mark.parametrize("names", [("one",), ("two",), ("three",), ("one", "three")])
def test_an_object_that_goes_takes_its_comment_and_no_other(
    tmp_path: Path, names: tuple[str, ...], ending: str
) -> None:
    def change(scene: Scene) -> Scene:
        return replaced(scene, objects=tuple(s for s in scene.objects if s.name not in names))

    text = saved(THREE.replace("\n", ending), tmp_path, change)[1]
    assert text == without(*names).replace("\n", ending)


def test_a_new_object_is_written_behind_the_others_without_defaults(tmp_path: Path) -> None:
    def change(scene: Scene) -> Scene:
        matte = {"type": "lambertian", "color": [0.5, 0.5, 0.5]}
        ball = replaced(scene.objects[0], name="four", material="new", radius=0.25)
        return replaced(
            scene,
            objects=(*scene.objects, ball),
            materials={**scene.materials, "new": matte},
        )

    lines = changed_lines(THREE, saved(THREE, tmp_path, change)[1])
    assert [line for line in lines if line[0] == "-"] == []
    assert [line[2:] for line in lines if line[2:]] == [
        "[materials.new]",
        'type = "lambertian"',
        "color = [0.5, 0.5, 0.5]",
        "[[objects]]",
        'shape = "sphere"',
        'name = "four"',
        'material = "new"',
        "center = [0.0, 0.0, 0.0]",
        "radius = 0.25",
    ]


def test_an_object_that_comes_next_to_one_that_goes_and_one_that_changes(tmp_path: Path) -> None:
    def change(scene: Scene) -> Scene:
        one, _, three = scene.objects
        new = replaced(one, name="new", center=(1.0, 1.0, 1.0))
        return replaced(scene, objects=(new, one, replaced(three, radius=9.0)))

    text = saved(THREE, tmp_path, change)[1]
    assert text.index('"new"') < text.index("# the first") < text.index('"one"')
    assert "two" not in text
    assert "# the third\n[[objects]]" in text
    assert "radius = 9.0\n" in text
    assert text.endswith("# the end\n")


def test_all_objects_may_go_and_come_back(tmp_path: Path) -> None:
    sky = {"color": (1.0, 1.0, 1.0)}

    def emptied(scene: Scene) -> Scene:
        return replaced(scene, objects=(), background=sky)

    _, text = saved(THREE, tmp_path, emptied)
    assert "[[objects]]" not in text
    assert "# --- the others ---" in text
    whole, back = saved(text, tmp_path, lambda s: replaced(s, objects=load_text(THREE).objects))
    assert [shape.name for shape in whole.objects] == ["one", "two", "three"]
    assert "# --- the others ---" in back


def load_text(text: str) -> Scene:
    return decode_scene(text.encode(), "a text")


def test_objects_in_an_inline_list_are_still_written(tmp_path: Path) -> None:
    inline = """\
camera = {position = [0, 0, 4], look_at = [0, 0, 0]} # inline
materials.a = {type = "light", emission = [1, 1, 1]}
objects = [{shape = "sphere", center = [0, 0, 0], radius = 1, material = "a"}]
"""

    def change(scene: Scene) -> Scene:
        return replaced(scene, objects=(*scene.objects, replaced(scene.objects[0], radius=2.0)))

    assert "# inline" in saved(inline, tmp_path, change)[1]
