"""The thesis's findings on macOS: suspicions planted as faults, and the symptoms they show.

There the picture was darker, shadows were harder, and green dots lay over all of it; nobody found
out why. The symptoms are measured as its author saw them, on the colours of the screen.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.scene import Scene
from tests.support.builders import box_of_quads, lamp, quad, scene_of
from tests.wgsl.device import Device
from tests.wgsl.display import DisplayPass
from tests.wgsl.program import RayTracer
from tests.wgsl.seeds import pcg
from tests.wgsl.text import Fault
from tests.wgsl.tracer import Tracer, naive

SIZE = 32
FRAMES = 128
SHADOW, LIGHT = np.s_[14:18, 5:12], np.s_[14:18, 20:27]  # under the board, and its mirror image
NAN = "bitcast<f32>(0x7FC00000u | settings.zero)"


class Symptoms(NamedTuple):
    """The symptoms of a picture, in figures."""

    brightness: float  # mean of all colours, of 255
    shadow: float  # the floor under the board, over the open floor
    green_dots: int  # pixels that are green alone

    def beside(self, healthy: "Symptoms") -> set[str]:
        """The thesis's symptoms, of its three, that are worse than in the healthy picture."""
        found = {
            "darker": self.brightness < 0.95 * healthy.brightness,
            "harder shadows": self.shadow < 0.9 * healthy.shadow,
            "green dots": self.green_dots > healthy.green_dots,
        }
        return {name for name, is_there in found.items() if is_there}


class Suspicion(NamedTuple):
    """A possible cause: faults of the text, a tracer with faults, a format of colours."""

    faults: tuple[Fault, ...] = ()
    tracer: type[Tracer] = Tracer
    texel: str = "rgba32float"


class SwappedTwice(Tracer):
    """The thesis's text does this: one target in every frame, the source never written."""

    def swap(self) -> None:
        """Once at the start of a frame and once at the end of the last one."""
        super().swap()
        super().swap()


class Stale(Tracer):
    """The random texture is never refreshed."""

    def refresh(self) -> None:
        """Do nothing."""


class ByIndex(Tracer):
    """Seeds of `hash(index + frame)`: a pixel has its neighbour's numbers one frame later."""

    def refresh(self) -> None:
        """Seeds of the next frame."""
        index = np.arange(SIZE * SIZE, dtype=np.uint32)
        self.random.write(pcg(index + np.uint32(self.samples)).reshape(SIZE, SIZE))


STORE = "textureStore(target_mean, place, vec4f(pixel.mean, pixel.dropped));"
TRUNCATED = STORE.replace("pixel.mean", "floor(pixel.mean * 255.0) / 255.0")
ENCODED = "return encode_srgb(clamp(color, vec3f(0.0), vec3f(1.0)));"
NOT_A_NUMBER = Fault(  # one sample in 8,192
    "path",
    "    return path.radiance;\n",
    f"    let bad = vec3f({NAN}, path.radiance.g, {NAN});\n"
    "    return select(path.radiance, bad, (seed & 0x1FFFu) == 0u);\n",
)
SUSPICIONS: Mapping[str, Suspicion] = {
    "colours kept in 8 bits, rounded": Suspicion(texel="rgba8unorm"),
    "colours kept in 8 bits, truncated": Suspicion((Fault("raytracer", STORE, TRUNCATED),)),
    "colours kept in 16 bits": Suspicion(texel="rgba16float"),
    "textures swapped twice a frame": Suspicion(tracer=SwappedTwice),
    "samples that are not numbers, in the mean": Suspicion(
        (NOT_A_NUMBER, Fault("film", "if (!is_finite(x))", "if (false)"))
    ),
    "samples that are not numbers, dropped as here": Suspicion((NOT_A_NUMBER,)),
    "random texture not refreshed": Suspicion(tracer=Stale),
    "seeds of hash(index + frame)": Suspicion(tracer=ByIndex),
    "loops that the driver ends after three rounds": Suspicion(
        (
            Fault(
                "path",
                "while (extend_path(&path, &rng)) {}",
                "for (var i = 0; i < 3; i++) {\n"
                "        if (!extend_path(&path, &rng)) {\n            break;\n        }\n    }",
            ),
        )
    ),
    "colours shown without the sRGB curve": Suspicion(
        (Fault("tonemap", ENCODED, "return clamp(color, vec3f(0.0), vec3f(1.0));"),)
    ),
}


def room() -> Scene:
    """White, under a lamp; a board hovers over the left half of the floor and shades it."""
    materials = {"white": {"type": "lambertian", "color": [0.75, 0.75, 0.75]}, "lamp": lamp(6.0)}
    board = quad([-1.5, -1.5, -1.5], [1.3, 0, 0], [0, 0, 1.5], "white")
    light = quad([-0.8, 1.9, -0.8], [1.6, 0, 0], [0, 0, 1.6], "lamp")
    eye = {"position": [0, -1.3, 1.9], "look_at": [0, -2, -0.6], "fov": 70}
    return scene_of([*box_of_quads("white", 2.0), board, light], materials, eye)


HEALTHY = Suspicion()


def symptoms(device: Device, suspicion: Suspicion = HEALTHY) -> Symptoms:
    """The symptoms of a suspicion, by default of none: of the version as it is."""
    scene = room()
    settings = naive(scene, width=SIZE, height=SIZE, tonemap="none")
    program = RayTracer(device, *suspicion.faults, texel=suspicion.texel)
    tracer = suspicion.tracer(program, scene, settings).render(FRAMES)
    codes: Any = DisplayPass(device, *suspicion.faults).codes(tracer.picture, settings)
    open_floor = max(codes[LIGHT].mean(), 1.0)  # a black picture has shadows of no kind
    is_green = (codes[..., 1] > 0) & (codes[..., 0] == 0) & (codes[..., 2] == 0)
    shade = codes[SHADOW].mean() / open_floor if codes.any() else 1.0
    return Symptoms(float(codes.mean()), float(shade), int(is_green.sum()))
