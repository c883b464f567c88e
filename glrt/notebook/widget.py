"""The widget of notebooks: a `Live` behind the messages of its page. It needs the extra."""

from base64 import b64encode
from importlib.resources import files
from typing import Any

import anywidget
import traitlets

from glrt.image.image import Image
from glrt.notebook.live import Live
from glrt.scene.scene import Scene
from glrt.settings import Settings


def _text(name: str) -> str:
    return files("glrt.notebook").joinpath(name).read_text("utf-8")


class LivePicture(anywidget.AnyWidget):
    """A live picture in a notebook: the value of `glrt.show`.

    A drag turns the camera, the wheel moves it, sliders change bounces, samples and lights. The
    picture gets samples while a page shows it. Its OpenGL objects are released when no page does.
    """

    _esm = _text("widget.js")
    _css = _text("widget.css")
    _title = traitlets.Unicode().tag(sync=True)
    _size = traitlets.List(traitlets.Int()).tag(sync=True)  # width and height, in pixels

    def __init__(self, live: Live, title: str) -> None:
        """Show `live` under a title, which is the text in place of a picture."""
        super().__init__(_title=title, _size=list(live.state.settings.size))
        self._live, self._pages = live, set[str]()
        self.on_msg(self._hear)

    @property
    def scene(self) -> Scene:
        """The scene as it is now, with the moved camera and other lights."""
        return self._live.state.scene

    @property
    def settings(self) -> Settings:
        """The settings as they are now."""
        return self._live.state.settings

    def image(self) -> Image:
        """Return the picture so far, with its error.

        Raises UsageError if there is none yet, or only a coarse one of a moving camera.
        """
        return self._live.image()

    def _repr_mimebundle_(self, **options: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the live picture and a still one, which pages show that have no kernel."""
        bundle = super()._repr_mimebundle_(**options)
        assert bundle is not None  # it has a view
        data, metadata = bundle
        if still := self._live.still():
            data[still.content["type"]] = b64encode(still.picture or b"").decode()
        return data, metadata

    def close(self) -> None:
        """Release the OpenGL objects and remove the picture from all pages."""
        if hasattr(self, "_live"):  # it may be closed before it is made
            self._live.rest()
        super().close()

    def _hear(self, _: Any, message: Any, __: Any) -> None:
        """Answer a page that asks for a picture; rest when the last page is closed."""
        page = message.get("page") if isinstance(message, dict) else None
        if not isinstance(page, str):
            return
        if message.get("kind") == "ask":
            self._pages.add(page)
            reply = self._live.answer(message.get("asked"))
            self.send({**reply.content, "page": page}, [reply.picture] if reply.picture else None)
        elif page in self._pages and message.get("kind") == "close":
            self._pages.discard(page)
            if not self._pages:
                self._live.rest()
