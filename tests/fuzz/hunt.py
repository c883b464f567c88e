"""Each kind of input with its check, run over as many of them as wanted."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from glrt.gpu.context import Context
from tests.fuzz import checks, models, pictures
from tests.fuzz.grammar import scenes
from tests.fuzz.mutation import broken_files, broken_scenes

Check = Callable[[Any], str]


def kinds(folder: Path, context: Context) -> dict[str, tuple[st.SearchStrategy[Any], Check]]:
    """Kinds of random input, each with its check; a check returns what became of the input."""
    wholes = {path.suffix: path for path in pictures.whole_pictures(folder)}
    exr, png = wholes[".exr"], wholes[".png"]

    def rendered(table: Any) -> str:
        scene = checks.parsed(table)
        if not scene:
            return "refused"
        checks.check_render(scene, context)
        return "rendered"

    def exported(table: Any) -> str:
        scene = checks.parsed(table)
        if not scene:
            return "refused"
        checks.check_exports(scene, folder)
        return "exported"

    def told(is_read: object) -> str:
        return "read" if is_read else "refused"

    return {
        "scenes by the grammar": (scenes(), rendered),
        "exported scenes": (scenes(), exported),
        "scenes with wrong values": (broken_scenes(), lambda t: told(checks.parsed(t))),
        "files with wrong bytes": (broken_files(), lambda b: told(checks.read(b, folder))),
        "broken EXR": (
            pictures.broken(exr.read_bytes()),
            lambda b: told(pictures.check_picture(b, exr)),
        ),
        "broken recipes": (
            pictures.broken(pictures.whole_recipe().to_json().encode()),
            lambda b: told(pictures.check_recipe(b)),
        ),
        "broken PNG": (
            pictures.broken(png.read_bytes()),
            lambda b: told(pictures.check_picture(b, png)),
        ),
        "words of models": (models.texts(), lambda it: models.check_model(it, folder)),
        "values of glTF": (models.values_of_gltf(), lambda it: models.check_model(it, folder)),
        "bytes of models": (models.bytes_of_models(), lambda it: models.check_model(it, folder)),
        "broken images": (models.images(), models.check_image),
        "broken grids": (models.grids(), models.check_grid),
    }


def hunt(inputs: st.SearchStrategy[Any], check: Check, count: int, start: int) -> Counter[str]:
    """Check `count` inputs, drawn from the seed `start`; how many came to which end.

    Raises what the check raises, with the smallest input that makes it.
    """
    ends: Counter[str] = Counter()

    @settings(
        max_examples=count,
        deadline=None,  # a kernel may compile
        database=None,
        suppress_health_check=list(HealthCheck),
        phases=[Phase.generate, Phase.shrink],
        print_blob=False,
    )
    @seed(start)
    @given(inputs)
    def run(value: Any) -> None:
        ends[check(value)] += 1

    run()
    return ends
