"""The hooks and the fixture of pytest. Nothing of the renderer is imported before a test asks."""

import json
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Generator

    from glrt.testing.pictures import Pictures

FIXTURE, MARK, WRITTEN = "picture", "pictures", "glrt_reference"
UPDATE, PAGE, ALPHA = "--glrt-update", "--glrt-html", "glrt_alpha"
_COUNT, _WRITTEN = pytest.StashKey[int](), pytest.StashKey["list[Path]"]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option and the setting."""
    group = parser.getgroup("glrt", "pictures rendered by glrt")
    group.addoption(
        UPDATE,
        action="store_true",
        help="write references of pictures that are missing or differ, instead of failing",
    )
    group.addoption(
        PAGE, metavar="FILE", help="write a page of all compared pictures, one .html file"
    )
    text = "largest chance that a run calls any equal picture different"
    parser.addini(ALPHA, text, default="1e-3")


def pytest_configure(config: pytest.Config) -> None:
    """Declare the marker, and refuse a chance that is none."""
    config.addinivalue_line("markers", f"{MARK}(count): number of pictures that a test checks")
    _alpha(config)
    if _is_first(config) and (parts := _parts(config)):
        shutil.rmtree(parts, ignore_errors=True)  # of a run that was killed


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Join what the processes found into one page."""
    parts = _parts(session.config)
    if not (_is_first(session.config) and parts):
        return
    from glrt.comparison.html import save_page
    from glrt.core.errors import GlrtError

    found = [json.loads(file.read_text("utf-8")) for file in sorted(parts.glob("*.json"))]
    try:
        save_page(found, session.config.getoption(PAGE))
    except GlrtError as error:
        raise pytest.UsageError(f"{PAGE}: {error}") from None
    shutil.rmtree(parts, ignore_errors=True)


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
    pictures = Pictures(item.path.parent, item.nodeid, share, most, update, _parts(config))
    item.stash[_WRITTEN] = pictures.written
    return pictures


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> "Generator[None, Any, Any]":
    """Add the references that the test wrote to its report, which xdist hands over."""
    report = yield
    report.user_properties += [(WRITTEN, str(file)) for file in item.stash.get(_WRITTEN, [])]
    return report


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Name the files that were written."""
    reports = terminalreporter.stats.get("passed", [])
    found = sorted({file for it in reports for key, file in it.user_properties if key == WRITTEN})
    page = terminalreporter.config.getoption(PAGE)
    for file in [*found, *([page] if page else [])]:
        terminalreporter.write_line(f"glrt: wrote {file}")


def _is_first(config: pytest.Config) -> bool:
    """Whether this is the process that the user started, not one of xdist."""
    return not hasattr(config, "workerinput")


def _parts(config: pytest.Config) -> Path | None:
    """The folder in which processes collect entries of the page."""
    page = config.getoption(PAGE)
    return config.invocation_params.dir / f"{page}.parts" if page else None


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
