"""Films of the window: each is shown in the docs, and a wrong name is refused."""

from pathlib import Path

import pytest

from bench.window_films import FILMS, main

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("name", FILMS)
def test_each_film_is_shown_in_the_guide_of_the_window(name: str) -> None:
    assert f"../pictures/{name}.webp" in (DOCS / "how-to" / "window.md").read_text()
    assert (DOCS / "pictures" / f"{name}.webp").exists()


def test_a_film_that_is_not_there_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nosuch"]) == 2
    assert "'nosuch'" in capsys.readouterr().err
