"""Why a scene is slow, where the user can change it."""

from glrt.methods.features import TREE_FROM, contents_of
from glrt.methods.table import CLASSIC
from glrt.scene.scene import Scene
from glrt.settings import Settings
from glrt.text import counted

MOST_AT_ONCE = TREE_FROM - 1  # shapes that a kernel holds as constants
MOST_BESIDE = 12  # shapes beside a tree that are worth no word
LONG = 16  # bounces: paths that are followed further have hardly any light left


def slow_because(scene: Scene, settings: Settings) -> list[str]:
    """A sentence or two for each reason: what takes the time, and what to do."""
    found = (_one_by_one(scene), _no_roulette(settings))
    return [text for text in found if text]


def _one_by_one(scene: Scene) -> str:
    """Shapes without a tree over them, when they are more than constants can hold."""
    contents = contents_of(scene)
    spheres = contents.shapes["sphere"]
    single = len(scene.objects) - (spheres if contents.has_tree else 0)
    if single <= (MOST_BESIDE if contents.has_tree else MOST_AT_ONCE):
        return ""
    kinds = [(n, kind) for kind, n in contents.shapes.items() if n and kind != "sphere"]
    count, kind = max(kinds, default=(spheres, "sphere"))
    advice = (
        "a box takes the place of six quads"
        if kind == "quad"
        else "leave out what the camera and the light do not need"
    )
    return (
        f"each ray is compared with {counted(single, 'shape')} one by one, most of them "
        f"{counted(count, kind)}: only spheres have a tree, from {TREE_FROM} on. With "
        f"{MOST_AT_ONCE} shapes or fewer in all, spheres too, a sample is several times as fast: "
        f"{advice}."
    )


def _no_roulette(settings: Settings) -> str:
    if settings.roulette or settings.bounces < LONG or settings.method in CLASSIC:
        return ""
    return (
        f"--no-roulette follows every path to its limit of {counted(settings.bounces, 'bounce')}, "
        "though it has hardly any light left: leave it out, or allow fewer --bounces."
    )
