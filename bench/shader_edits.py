"""Kernels whose shader text differs from glrt's: what a choice in it gives."""

from typing import NamedTuple

from glrt.gpu.glsl import read
from glrt.rendering.pipelines import Variant


class Edit(NamedTuple):
    """Another text in place of one that stands in a shader file, once or more often."""

    file: str
    old: str
    new: str


def edited(*edits: Edit) -> Variant:
    """A kernel with these edits, in turn; `KeyError` if one has no place."""
    texts: dict[str, str] = {}
    for edit in edits:
        text = texts.get(edit.file) or read(edit.file)
        if edit.old not in text:
            raise KeyError(f"{edit.file} does not hold `{edit.old}`")
        texts[edit.file] = text.replace(edit.old, edit.new)
    return Variant(texts=texts)
