"""The two halves from which the error of layers is estimated."""

import numpy as np

from tests.conftest import CallGlsl


def test_a_half_holds_whole_observations(call_glsl: CallGlsl) -> None:
    """The points of a block belong together: in both halves they would hide what they miss."""
    setup = """
        Layers layers = empty_layers();
        Path path = start_path(Ray(vec3(0.0), vec3(0.0, 0.0, -1.0), NO_SHAPE, false));
        add_layers(layers, path, index);
    """
    index = np.arange(96)
    for block in (1, 16, 64):
        counts = call_glsl(
            "vec2(layers.counts[0], layers.counts[1])",
            "vec2",
            setup,
            constants={"LAYERS": 2, "BLOCK": block},
            index=index,
        )
        side = index // block % 2
        assert np.array_equal(counts, np.column_stack([1 - side, side]))
