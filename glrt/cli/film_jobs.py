"""Jobs of render farms that render the frames of a film: `glrt film --export`."""

import json
import shlex
from collections.abc import Callable, Sequence
from typing import Any

Words = Sequence[str]

_OWN = ("--export", "--chunk", "--frames")  # options that the job gives or leaves out
_PARAMETER = "Frames"


def chunks(numbers: range, length: int) -> list[str]:
    """Return the frames of each task, such as 0-9, as `--frames` takes them."""
    starts = range(numbers.start, numbers.stop, length)
    return [f"{first}-{min(first + length, numbers.stop) - 1}" for first in starts]


def without_own(words: Words) -> list[str]:
    """Return the words of a command line without the options of the job itself."""
    found, skips = list[str](), False
    for word in words:
        if skips:
            skips = False
        elif word in _OWN:
            skips = True
        elif not word.startswith(tuple(f"{name}=" for name in _OWN)):
            found.append(word)
    return found


def _lines(words: Words, tasks: Words) -> str:
    return "".join(f"glrt {shlex.join([*words, '--frames', task])}\n" for task in tasks)


def _script(words: Words, tasks: Words) -> str:
    return f"#!/bin/sh\nset -e\n{_lines(words, tasks)}"


def _openjd(words: Words, tasks: Words) -> str:
    """Return a job template of Open Job Description 2023-09, as JSON."""
    frames = {"name": _PARAMETER, "type": "STRING", "range": list(tasks)}
    run = {"command": "glrt", "args": [*words, "--frames", f"{{{{Task.Param.{_PARAMETER}}}}}"]}
    step: dict[str, Any] = {
        "name": "Frames",
        "parameterSpace": {"taskParameterDefinitions": [frames]},
        "script": {"actions": {"onRun": run}},
    }
    job = {"specificationVersion": "jobtemplate-2023-09", "name": "glrt film", "steps": [step]}
    return json.dumps(job, indent=2) + "\n"


EXPORTS: dict[str, Callable[[Words, Words], str]] = {  # texts of jobs, by --export
    "sh": _script,
    "cuecmd": _lines,
    "openjd": _openjd,
}


def job(kind: str, words: Words, numbers: range, length: int) -> str:
    """Return the text of a job that renders frames, `length` of them in each task.

    `words` are the command line that asks for the job, from `film` on.
    """
    return EXPORTS[kind](without_own(words), chunks(numbers, length))
