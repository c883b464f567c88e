"""What made a picture, whole, as JSON that travels in the picture's metadata."""

import json
from typing import Any

from pydantic import Field, ValidationError

from glrt.errors import SceneError
from glrt.scene import Scene
from glrt.scene_file import parse_scene, scene_to_dict
from glrt.settings import MAX_SAMPLES, Frozen, Settings


class Recipe(Frozen):
    """Rendered again, it gives the same bits on the same driver."""

    scene: Scene = Field(description="the whole scene")
    settings: Settings = Field(description="every setting of the render, as it was asked for")
    samples: int = Field(description="samples of each pixel taken", ge=0, le=MAX_SAMPLES)
    version: str = Field(description="version of glrt")
    renderer: str = Field(description="name of the OpenGL driver")
    tier: str = Field("generic", description="where the kernel found its shapes")
    pipeline: str = Field("compute", description="the kind of shader")

    def to_json(self) -> str:
        """One line of ASCII that `from_json` reads back without loss."""
        table = self.model_dump(mode="json", exclude={"scene"})
        return json.dumps({"scene": scene_to_dict(self.scene), **table}, allow_nan=False)

    @classmethod
    def from_json(cls, text: str, source: str) -> "Recipe":
        """Read `to_json`'s text; `source` is what messages call the picture.

        Raises `SceneError` with one paragraph for anything else.
        """
        table = _table(text, source)
        scene = parse_scene(table.pop("scene"), f"{source} (scene of its recipe)")
        try:
            return cls.model_validate({"scene": scene, **table})
        except ValidationError as error:
            raise _damaged(source, _first_problem(error)) from None


def _table(text: str, source: str) -> dict[str, Any]:
    try:
        table = json.loads(text)
    except (ValueError, RecursionError):
        raise _damaged(source, "its metadata is not valid JSON") from None
    if not isinstance(table, dict) or not isinstance(table.get("scene"), dict):
        raise _damaged(source, "its metadata holds no scene")
    return table


def _first_problem(error: ValidationError) -> str:
    problem = error.errors(include_url=False, include_context=False, include_input=False)[0]
    key = ".".join(map(str, problem["loc"]))
    return f"{key}: {problem['msg'][:1].lower()}{problem['msg'][1:]}"


def _damaged(source: str, problem: str) -> SceneError:
    return SceneError(
        f"{source}: the recipe in this picture is damaged or not of this version of glrt: "
        f"{problem}. Render its scene file instead."
    )
