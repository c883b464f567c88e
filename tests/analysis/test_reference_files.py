"""References of scenes that name files."""

from pathlib import Path

import numpy as np
import pytest

from glrt.analysis.reference import Budget, reference_for
from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.sky_images import random_sky, write_exr


@pytest.mark.slow
def test_another_content_of_a_file_is_another_reference(
    context: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Though the scene file stays as it was."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    scenes = []
    for seed in (1, 2):
        write_exr(tmp_path / "sky.exr", random_sky(4, 2, seed=seed))
        table = {"position": [0, 0, 3], "look_at": [0, 0, 0]}
        sky = {"image": "sky.exr"}
        scenes.append(Scene.build(table, background=sky, folder=tmp_path))
    one, other = (
        reference_for(
            scene, settings_for(scene.render, width=16, height=8), context, Budget(0.5, 5)
        )
        for scene in scenes
    )
    assert len(list((tmp_path / "glrt/references").iterdir())) == 2
    assert not np.array_equal(one.first, other.first)
