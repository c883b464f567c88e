"""A scene of glrt in the words of Mitsuba 3: the dictionary that `mitsuba.load_dict` reads.

The converter is that of `glrt export`. Here nothing may be left out, and rough metal and glass are
glrt's own, as plug-ins.
"""

from typing import Any, NamedTuple

from glrt.core.errors import SceneError
from glrt.scene.export.mitsuba import convert as words
from glrt.scene.export.mitsuba.surfaces import (
    Surfaces,
    both_sides,
    both_sides_of,
    metal,
    principled,
)
from glrt.scene.export.mitsuba.textures import Turn
from glrt.scene.export.placing import near
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.facets import facet_loss
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.mitsuba import metal as our_metal
from tests.mitsuba import rough_glass
from tests.mitsuba.coincident import refuse_coincident
from tests.mitsuba.loaded import loaded
from tests.mitsuba.planes import reach_of_planes

BLOCK = 64  # samples of a pixel among which samplers spread their points

Words = dict[str, Any]


class Liberties(NamedTuple):
    """Changes that make Mitsuba faster, and may hardly show."""

    one_sided: bool = False  # quads light their front alone
    finite: bool = False  # planes end far away, or outside of the room that they are
    native: bool = False  # rough metal is Mitsuba's own, whose shadowing is not correlated
    sampler: str = "independent"  # of the samplers of Mitsuba; all others take BLOCK samples


def convert(mi: Any, scene: Scene, settings: Settings, liberties: Liberties) -> Words:
    """The scene for Mitsuba, whose variant is set.

    Raises SceneError for what Mitsuba cannot show: coincident faces, and lamps without end.
    """
    refuse_coincident(scene)
    our_metal.register(mi.variant())
    rough_glass.register(mi.variant())
    reach = reach_of_planes(scene) if liberties.finite else None
    kinds = liberties.sampler, BLOCK, liberties.one_sided, reach
    choices = words.Choices(near(scene), *kinds)
    surfaces = _Exact(scene, liberties.native)
    found: Words = loaded(mi, words.convert(scene, settings, choices, surfaces, _refuse))
    return found


def _refuse(thing: str) -> None:
    raise SceneError(f"Mitsuba would leave out {thing}.")


class _Exact(Surfaces):
    """Surfaces; rough ones are glrt's own, unless Mitsuba's are wanted."""

    def __init__(self, scene: Scene, is_native: bool) -> None:
        super().__init__(scene, _refuse)
        self._is_native = is_native

    def bsdf(self, name: str, material: Material, turn: Turn) -> Words:
        if isinstance(material, Dielectric) and _has_plug_in(material):
            loss = facet_loss(material.alpha, material.ior)
            return rough_glass.words(material.alpha, material.ior, loss)
        if isinstance(material, Metal) and material.alpha:
            return both_sides(metal(material, turn) if self._is_native else _rough(material))
        if isinstance(material, Principled) and _is_shared_metal(material):
            return both_sides_of(material, principled(material, turn))
        return super().bsdf(name, material, turn)


def _has_plug_in(material: Dielectric) -> bool:
    """Whether it is rough glass as the plug-in knows it: no pane, and against air alone."""
    return material.alpha > 0 and not material.thin and material.priority is None


def _is_shared_metal(material: Principled) -> bool:
    """Whether Disney's surface is glTF's, except shadowing at high roughness."""
    return material.metallic == 1 and not (
        material.clearcoat or material.has_holes or material.textures
    )


def _rough(material: Metal) -> Words:
    white = {"type": "rgb", "value": [1.0, 1.0, 1.0]}
    found = {"type": our_metal.NAME, "alpha": material.alpha}
    if not material.conductor:
        return {**found, "reflectance": {"type": "rgb", "value": list(material.color or ())}}
    n, k = material.conductor
    indices = {f"{name}{c}": v for name, it in (("n", n), ("k", k)) for c, v in enumerate(it)}
    return {**found, "reflectance": white, **indices}
