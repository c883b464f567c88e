"""Kernels with edited shader sources, to measure the effect of a choice in them."""

from typing import NamedTuple

from glrt.gpu.glsl import read
from glrt.rendering.pipelines import Variant


class Edit(NamedTuple):
    """The replacement of every occurrence of a text in a shader file."""

    file: str
    old: str
    new: str


def edited(*edits: Edit) -> Variant:
    """A kernel with these edits in order; raises `KeyError` if a text to replace is not found."""
    texts: dict[str, str] = {}
    for edit in edits:
        text = texts.get(edit.file) or read(edit.file)
        if edit.old not in text:
            raise KeyError(f"{edit.file} does not hold `{edit.old}`")
        texts[edit.file] = text.replace(edit.old, edit.new)
    return Variant(texts=texts)
