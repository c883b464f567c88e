"""A scene as a scene file of Mitsuba, of what that format holds."""

from glrt.core.text import number
from glrt.core.version import VERSION
from glrt.scene.export.companions import Companions
from glrt.scene.export.left_out import LeftOut
from glrt.scene.export.mitsuba.convert import Choices, convert
from glrt.scene.export.mitsuba.sharing import instanced, with_references
from glrt.scene.export.mitsuba.surfaces import Surfaces
from glrt.scene.export.mitsuba.xml import XmlWriter
from glrt.scene.export.placing import as_it_is
from glrt.scene.scene import Scene
from glrt.settings import Settings

_SMALL = 0.1  # extent of a scene from which Mitsuba lifts rays by 1e-3 of it and more


def to_mitsuba(scene: Scene, settings: Settings, companions: Companions) -> tuple[str, list[str]]:
    """Return the text of a scene file, and what is left out or changed, in words.

    `companions` receives the files that it names. The scene keeps its coordinates.
    """
    left_out = LeftOut()
    choices = Choices(as_it_is(scene), sample_count=settings.samples)
    if choices.at.extent < _SMALL:
        left_out(
            f"exactness at this size: the scene is {number(choices.at.extent)} large, and Mitsuba "
            "lifts rays by 1e-4 off surfaces"
        )
    words = convert(scene, settings, choices, Surfaces(scene, left_out), left_out)
    head = f"{scene.title or 'A scene'}, by glrt {VERSION}"
    text = XmlWriter(companions).text(with_references(instanced(words)), head)
    return text, left_out.things
