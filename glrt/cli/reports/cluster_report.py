"""The workers of `--cluster`, with the progress of all of them in one line."""

import argparse
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from glrt.cli.reports.progress import progress_of_all
from glrt.cluster.clusters import opened
from glrt.cluster.crew import Crew
from glrt.rendering.stopping import Interruption

_ADVICE = {  # by what workers render
    "frame": "Finished frames are kept: start it again, and the same command continues.",
    "band": "Finished bands are kept: start it again, and the same command continues.",
}


@contextmanager
def crew_of(arguments: argparse.Namespace, interruption: Interruption, unit: str) -> Iterator[Crew]:
    """Yield the workers of `--cluster`; `unit`: what they render, as "frame".

    Raises `RenderError` if the cluster cannot be reached, and `UsageError` for a file that is none.
    """
    with ExitStack() as stack:
        client = stack.enter_context(opened(arguments.cluster))
        place = arguments.cluster.text
        crew = Crew(client, place, arguments.context, interruption, _say)
        crew.advice = _ADVICE[unit]
        if arguments.progress or (not arguments.quiet and sys.stderr.isatty()):
            crew.show = stack.enter_context(progress_of_all(unit, arguments.progress))
        yield crew


def _say(text: str) -> None:
    print(f"glrt: caution: {text}", file=sys.stderr, flush=True)
