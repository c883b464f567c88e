"""Variants of the materials of a glTF file (KHR_materials_variants)."""

from typing import Any, NamedTuple

from glrt.core.errors import ContentError
from glrt.scene.model_files.gltf.document import Document

EXTENSION = "KHR_materials_variants"
Numbers = tuple[int | None, ...]


def variant_names(document: Document) -> tuple[str, ...]:
    """Return a different name for each variant: its own, or its number from 0."""
    listed = document.extension(document.json, EXTENSION, "the file") or {}
    found = list[str]()
    for number, variant in enumerate(document.list(listed.get("variants", []), "variants")):
        name = document.table(variant, f"variants[{number}]").get("name")
        usable = isinstance(name, str) and name.isprintable() and name not in found
        found.append(name if usable and name else str(number))
    return tuple(found)


class Choices(NamedTuple):
    """The materials of a primitive by number; None for no material."""

    usual: int | None  # without a variant
    varied: Numbers  # for each variant of the file


def choices_of(document: Document, primitive: dict[str, Any], count: int, here: str) -> Choices:
    """Return the materials of a primitive in a file of `count` variants; ValueError if missing."""
    usual = _material(document, primitive, here) if "material" in primitive else None
    varied = [usual] * count
    own = document.extension(primitive, EXTENSION, here) or {}
    for place, given in enumerate(document.list(own.get("mappings", []), f"{here}.mappings")):
        where = f"{here}.mappings[{place}]"
        mapping = document.table(given, where)
        for variant in document.list(mapping.get("variants"), f"{where}.variants"):
            if type(variant) is not int or not 0 <= variant < count:
                raise ContentError(f"{where} names a variant that there is not")
            varied[variant] = _material(document, mapping, where)
    return Choices(usual, tuple(varied))


def _material(document: Document, table: dict[str, Any], here: str) -> int:
    document.item("materials", table.get("material"), f"{here}.material")
    index: int = table["material"]
    return index
