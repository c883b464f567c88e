"""The recipe of a picture: all that renders it again, as JSON in the picture's metadata."""

import json
import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, ValidationError, model_validator

from glrt.core.errors import SceneError
from glrt.denoise.filters import least_samples
from glrt.image.partition import Partition
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import Layering, Plan, Weights, are_trivial
from glrt.scene.loading.scene_files import hashes_of, with_hashes
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import LARGEST, parse_scene, scene_to_dict
from glrt.settings import MAX_SAMPLES, Frozen, Settings, settings_for

# Values of keys that older recipes lack, where they are not today's defaults.
BEFORE_THEM: dict[str, Any] = {"linked": 0.0}

Factor = Annotated[float, Field(ge=0)]
Factors = tuple[Factor, Factor, Factor]


class Traced(Frozen):
    """The light that was traced, if the picture is a weighted sum of its layers."""

    scene: Scene = Field(description="the scene with the lights that were traced")
    bounces: int = Field(description="the bounce limit that was traced", ge=0, le=1000)
    layering: Layering = Field(description="what the layers hold: light groups, or path lengths")
    weights: tuple[Factors, ...] = Field(description="a factor for each channel of each layer")

    @property
    def plan(self) -> Plan:
        """The plan that was traced; its settings are the scene's, except the bounces."""
        settings = settings_for(self.scene.render, bounces=self.bounces)
        return Plan(SceneFacts(self.scene), settings, self.layering)

    @model_validator(mode="after")
    def _has_a_weight_for_each_layer(self) -> Self:
        if len(self.weights) not in (1, self.plan.layers):
            raise ValueError(f"{len(self.weights)} weights for {self.plan.layers} layers")
        return self


def traced(film: Plan, weights: Weights) -> Traced | None:
    """The record of a film that is shown under weights, for a recipe; None if they are all 1."""
    if are_trivial(weights):
        return None
    return Traced(
        scene=film.scene, bounces=film.settings.bounces, layering=film.layering, weights=weights
    )


def lasting(decisions: Mapping[str, str], chosen: Settings, now: Settings) -> dict[str, str]:
    """The `decisions` about settings that still have the values that were `chosen`."""
    return {k: v for k, v in decisions.items() if getattr(now, k) == getattr(chosen, k)}


class FrameLimits(Frozen):
    """When the render of a frame of a film was to end, other than by its samples."""

    number: int = Field(description="number of the frame, from 0", ge=0)
    seconds: float | None = Field(None, description="seconds that it was given", gt=0)
    error: float | None = Field(None, description="the error that it was to reach", gt=0)
    reached: bool = Field(True, description="whether it reached that error")


class Recipe(Frozen):
    """All that made a picture; rendered again, it gives the same bits on the same driver."""

    scene: Scene = Field(description="the whole scene, as it is shown")
    settings: Settings = Field(description="every setting of the render, as it was asked for")
    samples: int = Field(description="samples of each pixel taken", ge=0, le=MAX_SAMPLES)
    version: str = Field(description="version of glrt")
    renderer: str = Field(description="name of the OpenGL driver")
    tier: str = Field("generic", description="where the kernel, or each of two, found its shapes")
    pipeline: str = Field("compute", description="the kind of shader")
    traced: Traced | None = Field(
        None,
        description="the light that was traced, if it differs from the scene's, and its weights",
    )
    partition: Partition | None = Field(
        None, description="the parts that the picture was merged from, or the part that it is"
    )
    decisions: dict[str, str] = Field(
        {}, description="by what the program chose a setting in the user's place, by its name"
    )
    apart: Literal["repeated", "large"] = Field(
        "repeated",
        description="which meshes had trees of their own: large ones too, once one was moved in "
        "the window",
    )

    frame: FrameLimits | None = Field(None, description="the frame of a film that the picture is")

    @model_validator(mode="after")
    def _has_samples_for_each_part(self) -> Self:
        if self.partition and not self.samples <= self.partition.samples(self.settings):
            raise ValueError(f"{self.samples} samples are not of its parts, {self.partition}")
        return self

    @model_validator(mode="after")
    def _decisions_are_about_settings(self) -> Self:
        if unknown := self.decisions.keys() - Settings.model_fields.keys():
            raise ValueError(f"decisions about no setting: {', '.join(sorted(unknown))}")
        return self

    @property
    def taken(self) -> Settings:
        """The settings with the samples that were really taken; parts keep those of all samples.

        A render that ended before it could be denoised has no denoiser.
        """
        if self.partition:
            return self.settings
        taken = {"samples": self.samples or self.settings.samples}
        if taken["samples"] < least_samples(self.settings.block):
            return self.settings.model_copy(update={**taken, "denoise": "none"})
        return self.settings.model_copy(update=taken)

    @property
    def assets(self) -> dict[str, str]:
        """SHA-256 in hex of each file that the scene names, by its path."""
        return hashes_of(self.scene)

    def to_json(self) -> str:
        """The recipe as one line of ASCII, which `from_json` reads back without loss."""
        table = self.model_dump(mode="json", exclude={"scene": True, "traced": True})
        if self.traced:
            light = self.traced.model_dump(mode="json", exclude={"scene"})
            table["traced"] = {"scene": scene_to_dict(self.traced.scene), **light}
        if self.assets:
            table["assets"] = self.assets
        return json.dumps({"scene": scene_to_dict(self.scene), **table}, allow_nan=False)

    @classmethod
    def from_json(cls, text: str, source: str) -> "Recipe":
        """Read the text of `to_json`; messages call the picture `source`.

        Raises `SceneError` with one paragraph for any other text.
        """
        table = _table(text, source)
        hashes = _hashes(table.pop("assets", {}), source)

        def parsed(scene: dict[str, Any], what: str) -> Scene:
            return with_hashes(parse_scene(scene, f"{source} ({what} of its recipe)"), hashes)

        table["scene"] = parsed(table["scene"], "scene")
        if isinstance(table.get("settings"), dict):
            table["settings"] = {**BEFORE_THEM, **table["settings"]}
        light = table.get("traced")
        if isinstance(light, dict) and isinstance(light.get("scene"), dict):
            table["traced"] = {**light, "scene": parsed(light["scene"], "scene traced,")}
        try:
            return cls.model_validate(table)
        except ValidationError as error:
            raise _damaged(source, _first_problem(error)) from None


def _table(text: str, source: str) -> dict[str, Any]:
    if len(text) > LARGEST:
        raise _damaged(source, f"its metadata are longer than {LARGEST >> 20} MiB")
    try:
        table = json.loads(text)
    except (ValueError, RecursionError):
        raise _damaged(source, "its metadata is not valid JSON") from None
    if not isinstance(table, dict) or not isinstance(table.get("scene"), dict):
        raise _damaged(source, "its metadata holds no scene")
    return table


def _hashes(table: Any, source: str) -> dict[str, str]:
    texts = list(table.values()) if isinstance(table, dict) else [None]
    if not all(isinstance(text, str) and re.fullmatch("[0-9a-f]{64}", text) for text in texts):
        raise _damaged(source, "its assets are not SHA-256 by path")
    return dict(table)


def _first_problem(error: ValidationError) -> str:
    problem = error.errors(include_url=False, include_context=False, include_input=False)[0]
    key = ".".join(map(str, problem["loc"]))
    return f"{key}: {problem['msg'][:1].lower()}{problem['msg'][1:]}"


def _damaged(source: str, problem: str) -> SceneError:
    return SceneError(
        f"{source}: the recipe in this picture is damaged or not of this version of glrt: "
        f"{problem}. Render its scene file instead."
    )
