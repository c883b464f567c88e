"""Parts of a scene that are equal, held once: surfaces, media, and meshes that are instances."""

from collections import Counter
from typing import Any

from glrt.scene.export.mitsuba.words import COMMENT, MARK, Named, Words

_OWN = ("emitter", "interior", "exterior")  # what an instance of Mitsuba cannot have
_KINDS = {"bsdf": "bsdf", "medium": "medium", "interior": "medium", "exterior": "medium"}


def instanced(words: Words) -> Words:
    """Return a scene in which meshes that are equal, apart from their place, are held once.

    Meshes that emit or bound a medium stay as they are, as Mitsuba has no such instances.
    """
    counts = Counter(key for it in words.values() if (key := _key(it)))
    groups = {key: f"group-{n}" for n, key in enumerate(k for k, c in counts.items() if c > 1)}
    found: Words = {}
    for name, it in words.items():
        key = _key(it)
        if key not in groups:
            found[name] = it
            continue
        mark = groups[key]
        if mark not in found:
            inner = {part: value for part, value in it.items() if part not in ("to_world", COMMENT)}
            found[mark] = {"type": "shapegroup", MARK: mark, "shape": inner}
        told = {COMMENT: it[COMMENT]} if COMMENT in it else {}
        found[name] = {"type": "instance", "to_world": it["to_world"], "group": Named(mark), **told}
    return found


def with_references(words: Words) -> Words:
    """Return a scene with its surfaces and media in front, which the rest refers to by marks."""
    known = dict[int, tuple[str, Words]]()
    rest = {name: _referring(it, known) for name, it in words.items()}
    front = {mark: {**part, MARK: mark} for mark, part in known.values()}
    return {"type": "scene", **front, **rest}


def _key(words: Any) -> tuple[int, int] | None:
    """Return what meshes share that may be instances of one; None for all else."""
    is_mesh = isinstance(words, dict) and words.get("type") == "mesh" and "to_world" in words
    if not is_mesh or any(part in words for part in _OWN):
        return None
    return id(words["form"]), id(words["bsdf"])


def _referring(words: Any, known: dict[int, tuple[str, Words]]) -> Any:
    if not isinstance(words, dict):
        return words
    found = {}
    for key, part in words.items():
        if (kind := _KINDS.get(key)) is None:
            found[key] = _referring(part, known) if key == "shape" else part
            continue
        if id(part) not in known:
            number = sum(mark.startswith(kind) for mark, _ in known.values())
            known[id(part)] = f"{kind}-{number}", part
        found[key] = Named(known[id(part)][0])
    return found
