"""The advice on what to install works where glrt is used: from a checkout, or from a wheel."""

import re
import sys
import tomllib
from pathlib import Path

import pytest

from glrt.core import install as module
from glrt.core.install import install

ROOT = Path(__file__).parents[2]
EXTRAS = set(
    tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
)
CALL = re.compile(r"install\(\"(\w+)\"\)|install\('(\w+)'\)|install\((extra)\)")


def test_in_a_checkout_it_names_the_checkout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "executable", str(ROOT / ".venv" / "bin" / "python"))
    monkeypatch.chdir(ROOT)
    assert install("chart") == ".venv/bin/python -m pip install -e '.[chart]'"
    monkeypatch.chdir(tmp_path)
    assert install("chart") == f"{ROOT}/.venv/bin/python -m pip install -e '{ROOT}[chart]'"


def test_in_a_wheel_it_names_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/opt/a b/bin/python")
    monkeypatch.setattr(module, "_ROOT", tmp_path)
    assert install("view") == "'/opt/a b/bin/python' -m pip install 'glrt[view]'"


def test_all_advice_comes_from_there() -> None:
    """No module writes such a command itself, and each extra is one of the package."""
    named = set[str]()
    for path in sorted((ROOT / "glrt").rglob("*.py")):
        text = path.read_text()
        if path.name == "install.py":
            continue
        assert not re.search(r"pip\W+install", text), path
        named |= {found for match in CALL.findall(text) for found in match if found}
    assert named - {"extra"} <= EXTRAS
    assert {"view", "film", "denoise", "draco", "notebook", "chart", "gpu"} <= named
