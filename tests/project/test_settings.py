"""Settings stand once: keywords for editors follow the model; widgets leave the schema alone."""

import json
from typing import Annotated, get_args, get_origin, get_type_hints

from glrt.scene.scene import Scene
from glrt.setting_options import SettingOptions
from glrt.settings import Settings


def test_the_keywords_for_editors_are_the_fields_of_the_model() -> None:
    hints = get_type_hints(SettingOptions)
    assert set(hints) == set(Settings.model_fields)
    for name, field in Settings.model_fields.items():
        assert hints[name] == plain(field.annotation), name


def plain(annotation: object) -> object:
    """A type without what pydantic and widgets add to it."""
    if get_origin(annotation) is Annotated:
        return plain(get_args(annotation)[0])
    parts = get_args(annotation)
    if not parts or not all(isinstance(part, type) or get_args(part) for part in parts):
        return annotation
    if get_origin(annotation) is tuple:
        return tuple[tuple(plain(part) for part in parts)]  # type: ignore[misc]
    if type(None) in parts:
        first, second = (plain(part) for part in parts)
        return first | second  # type: ignore[operator]
    return annotation


def test_the_schema_of_scene_files_holds_nothing_about_widgets() -> None:
    text = json.dumps(Scene.model_json_schema())
    assert not [word for word in ('"slider"', '"cost"', '"unit"') if word in text]
