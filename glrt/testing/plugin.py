"""The hooks and the fixture of pytest. Nothing of the renderer is imported before a test asks."""

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from glrt.testing.pictures import Pictures

FIXTURE, MARK, WRITTEN = "picture", "pictures", "glrt_reference"
UPDATE, ALPHA = "--glrt-update", "glrt_alpha"
_COUNT = pytest.StashKey[int]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option and the setting."""
    parser.getgroup("glrt", "pictures rendered by glrt").addoption(
        UPDATE,
        action="store_true",
        help="write references of pictures that are missing or differ, instead of failing",
    )
    text = "largest chance that a run calls any equal picture different"
    parser.addini(ALPHA, text, default="1e-3")


def pytest_configure(config: pytest.Config) -> None:
    """Declare the marker, and refuse a chance that is none."""
    config.addinivalue_line("markers", f"{MARK}(count): number of pictures that a test checks")
    _alpha(config)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Count the pictures of the run; each process of xdist collects all tests."""
    session.config.stash[_COUNT] = sum(
        _declared(item) for item in session.items if FIXTURE in getattr(item, "fixturenames", ())
    )


@pytest.fixture
def picture(request: pytest.FixtureRequest) -> "Pictures":
    """Check pictures against references: `picture.check(scene)`, `picture.same_bits(scene)`."""
    from glrt.testing.pictures import Pictures

    config, item = request.config, request.node
    share = _alpha(config) / max(config.stash.get(_COUNT, 1), 1)
    most, update = _declared(item), config.getoption(UPDATE)
    return Pictures(item.path.parent, item.nodeid, share, most, update, item.user_properties)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Name the references that were written."""
    reports = terminalreporter.stats.get("passed", [])
    found = sorted({file for it in reports for key, file in it.user_properties if key == WRITTEN})
    for file in found:
        terminalreporter.write_line(f"glrt: wrote {file}")


def _declared(item: Any) -> int:
    mark = item.get_closest_marker(MARK)
    return int(mark.args[0]) if mark and mark.args else 1


def _alpha(config: pytest.Config) -> float:
    text = str(config.getini(ALPHA))
    try:
        found = float(text)
    except ValueError:
        found = 0.0
    if not 0 < found < 1:
        raise pytest.UsageError(f"{ALPHA} must be a number between 0 and 1, got {text!r}.")
    return found
