"""Where charts go: into a folder, onto a page that needs no network, or both."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from glrt.analysis.plot import check_matplotlib
from glrt.core import files
from glrt.core.errors import UsageError
from glrt.core.web_page import check_page, check_page_name


class Outputs(NamedTuple):
    """A folder for charts and tables, and a page; None where one is not wanted."""

    folder: Path | None
    page: Path | None


def prepare_outputs(folder: str | Path | None, page: str | None, names: Sequence[str]) -> Outputs:
    """Make the folder, for files of these names, and check that all can be written.

    Raises UsageError if they cannot, if matplotlib is missing, which draws the charts of the
    folder, or if neither is given. Nothing is left behind then.
    """
    if not folder and not page:
        raise UsageError("the output is missing: give -o DIR, --html FILE, or both.")
    outputs = Outputs(Path(folder) if folder else None, Path(page) if page else None)
    inside = False
    if outputs.page:
        check_page_name(outputs.page, "--html")
        inside = bool(folder) and outputs.page.parent.resolve() == Path(str(folder)).resolve()
        if not inside:
            check_page(outputs.page, "--html")
    if outputs.folder:
        check_matplotlib()
        more = [outputs.page.name] if outputs.page and inside else []
        files.make_folder(outputs.folder, *names, *more)
    return outputs
