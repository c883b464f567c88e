"""Every picture of docs has a recipe, and every recipe can be followed."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from bench import pictures
from bench.composites import DOCS, One, code_of, leaks
from bench.contact_sheet import MOST_BYTES
from bench.pictures import RECIPES, main, make
from bench.sheets import in_rows, write_sheet
from bench.stress_sheets import cases_of_sheets, write_small
from glrt.core.errors import RenderError, UsageError
from glrt.lab.cases import CASES

COMMANDS = {" ".join(it): it for it in RECIPES.values() if isinstance(it, tuple)}
ONES = {name: recipe for name, recipe in RECIPES.items() if isinstance(recipe, One)}


def test_every_picture_of_docs_has_a_recipe() -> None:
    assert sorted(RECIPES) == sorted(file.name for file in (DOCS / "pictures").iterdir())


def test_every_picture_is_shown_on_a_page() -> None:
    pages = [DOCS.parent / "README.md", *DOCS.rglob("*.md")]
    text = "".join(page.read_text("utf-8") for page in pages)
    assert [name for name in RECIPES if f"pictures/{name})" not in text] == []


def test_every_picture_is_small_enough_for_the_repository() -> None:
    sizes = {name: (DOCS / "pictures" / name).stat().st_size for name in RECIPES}
    assert {name: size for name, size in sizes.items() if size > MOST_BYTES} == {}


@pytest.mark.parametrize("words", COMMANDS.values(), ids=[*COMMANDS])
def test_a_command_is_of_a_program_and_names_what_it_writes(words: tuple[str, ...]) -> None:
    dash, module, *rest = words
    assert dash == "-m"
    assert module == "glrt" or (DOCS.parent / f"{module.replace('.', '/')}.py").exists()
    assert {"{file}", "{folder}"} & {*rest}


@pytest.mark.parametrize("one", ONES.values(), ids=[*ONES])
def test_a_scene_of_a_recipe_is_there(one: One) -> None:
    assert one.scene.objects


def test_stress_sheets_show_every_case_once_in_order() -> None:
    assert [case for _, cases in cases_of_sheets() for case in cases] == [*CASES.values()]


def test_a_command_that_writes_no_picture_is_reported(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match="did not write it"):
        make(("-c", "pass", "{file}"), tmp_path / "a.jpg")
    with pytest.raises(RenderError, match="exit code 3"):
        make(("-c", "raise SystemExit(3)"), tmp_path / "a.jpg")


def test_a_failure_is_reported_after_the_other_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(file: Path) -> None:
        raise RenderError("no paint")

    recipes = {"a.jpg": fail, "b.jpg": lambda file: file.write_bytes(b"painted")}
    monkeypatch.setattr(pictures, "RECIPES", recipes)
    assert main(["-o", str(tmp_path)]) == RenderError.exit_code
    assert "1 picture not made. a.jpg: no paint" in capsys.readouterr().err
    assert (tmp_path / "b.jpg").read_bytes() == b"painted"


def test_an_unknown_picture_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["drnk"]) == UsageError.exit_code
    assert "'drnk'" in (text := capsys.readouterr().err)
    assert "drink" in text


def test_code_that_a_page_lost_is_reported() -> None:
    with pytest.raises(UsageError, match=r"films\.md has no code with '# lost\.toml'"):
        code_of("how-to/films.md", "# lost.toml")


def test_pictures_stand_in_rows_with_paper_between(tmp_path: Path) -> None:
    dark, light = np.zeros((2, 3, 3), np.uint8), np.full((2, 3, 3), 200, np.uint8)
    sheet = in_rows([dark, light, light], 2, 1)
    assert sheet[..., 0].tolist() == [
        *2 * [[0, 0, 0, 255, 200, 200, 200]],
        7 * [255],
        *2 * [[200, 200, 200, 255, 255, 255, 255]],
    ]
    write_sheet(tmp_path / "a.png", sheet)
    with Image.open(tmp_path / "a.png") as read:
        assert np.array_equal(np.asarray(read), sheet)


def test_a_sheet_that_is_too_large_is_refused(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (400, 400, 3), np.uint8)
    with pytest.raises(RenderError, match="has more than 300000 bytes"):
        write_sheet(tmp_path / "a.png", noise)
    assert not [*tmp_path.iterdir()]


def test_a_sheet_of_charts_gets_as_few_colors_as_it_must(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (800, 800, 3), np.uint8)
    drawn, file = tmp_path / "drawn.png", tmp_path / "a.png"
    for edge, most in ((100, 255), (640, 64)):
        Image.fromarray(noise[:edge, :edge]).save(drawn)
        write_small(file, drawn)
        with Image.open(file) as small:
            assert len(small.getcolors(256) or []) <= most
            assert small.size == (edge, edge)
    Image.fromarray(noise).save(drawn)
    with pytest.raises(RenderError, match="has more than 300000 bytes"):
        write_small(file, drawn)


@pytest.mark.slow
def test_light_leaks_without_visibility_and_without_bias_alone(tmp_path: Path) -> None:
    leaks(tmp_path / "leaks.png")
    with Image.open(tmp_path / "leaks.png") as picture:
        codes = np.asarray(picture.convert("RGB"))
    parts = [codes[:, left : left + 200].mean() for left in range(0, codes.shape[1], 204)]
    assert min(parts[:2]) > 10 * max(parts[2:])
