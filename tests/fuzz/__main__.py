"""`python -m tests.fuzz [--count N] [--seed S]`: a long hunt, with its counts and its memory."""

import argparse
import resource
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from glrt.gpu.context import open_context
from tests.fuzz.hunt import hunt, kinds


def main() -> None:
    """Share the inputs out to the kinds, and print what became of them."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=20_000, help="inputs in all")
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    context = open_context("auto")
    with TemporaryDirectory() as folder:
        table = kinds(Path(folder), context)
        for name, (inputs, check) in table.items():
            start = time.perf_counter()
            ends = hunt(inputs, check, -(-chosen.count // len(table)), chosen.seed)
            told = ", ".join(f"{count} {end}" for end, count in sorted(ends.items()))
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
            seconds = time.perf_counter() - start
            print(f"{name:26} {told:32} {seconds:6.0f} s, peak {peak} MB", flush=True)


if __name__ == "__main__":
    main()
