"""Sweeps on a Dask cluster: each task runs one shard with the program `eomgen` on a worker.

    >>> from dask.distributed import Client
    >>> import eomgen.dask
    >>> client = Client("tcp://node1:8786")
    >>> eomgen.dask.sweep(client, ["arm.toml", "--vary", "omega=10:60:100", "--measure", "poincare",
    ...                            "--out", "map"], shards=32)

All workers must share a file system. If a worker is lost, Dask reassigns its shards, and the new worker resumes
them. The command `eomgen sweep --engine dask` calls this module.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from typing import Any, Callable, Iterable, List, Mapping, Optional, Sequence

from . import _arguments

__all__ = ["SweepError", "sweep"]

# Largest number of shards.
MAX_SHARDS = 100_000


class SweepError(RuntimeError):
    """Error of a failed shard, with the message of the program."""


def _run(command: Sequence[str], folder: Optional[str] = None) -> str:
    """Runs the program in a folder and returns its output. Relative paths in its arguments refer to this folder."""
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    except OSError as error:
        raise SweepError(f"{command[0]} cannot be run: {error.strerror}") from None
    if done.returncode != 0:
        why = done.stderr.strip() or f"exit status {done.returncode}"
        raise SweepError(f"{' '.join(command)}: {why}")
    return done.stdout


def _texts(arguments: Any) -> List[str]:
    """Returns the arguments of the program as texts."""
    expected = "the arguments of eomgen sweep, such as [\"arm.toml\", \"--out\", \"map\"]"
    if isinstance(arguments, (str, bytes, Mapping)) or not isinstance(arguments, Iterable):
        raise TypeError(_arguments.rejected("arguments", arguments, expected))
    return [_arguments.path("arguments", argument, expected) for argument in arguments]


def _folder(arguments: Sequence[str]) -> str:
    """Returns the value of --out."""
    for place, argument in enumerate(arguments):
        if argument == "--out" and place + 1 < len(arguments):
            return arguments[place + 1]
        if argument.startswith("--out="):
            return argument[len("--out=") :]
    raise ValueError("--out is missing: expected --out FOLDER among the arguments of the sweep")


def sweep(
    client: Any,
    arguments: Sequence[str],
    shards: int = 16,
    *,
    program: str = "eomgen",
    progress: Optional[Callable[[int, int], object]] = None,
) -> str:
    """Runs all shards of a sweep on a cluster and merges them. Returns the output of `eomgen merge`.

    client: a dask.distributed.Client. arguments: arguments of `eomgen sweep` without `--shard`, as texts.
    shards: number of shards. program: path of the program, the same on all machines. progress: function of
    the number of completed shards and the number of all shards.

    Raises SweepError if a shard fails. Exceptions of Dask are not caught, such as KilledWorker if the workers of
    a shard are lost repeatedly.
    """
    arguments = _texts(arguments)
    shards = _arguments.whole("shards", shards, MAX_SHARDS, 1)
    program = _arguments.path("program", program, "the path of the program eomgen")
    _arguments.function("progress", progress, "a function of two numbers of shards")
    if not hasattr(client, "map"):
        raise TypeError(_arguments.rejected("client", client, "a dask.distributed.Client"))
    from dask.distributed import as_completed

    folder, here = _folder(arguments), os.getcwd()
    numbered = [f"{number}/{shards}" for number in range(1, shards + 1)]
    commands = [[program, "sweep", *arguments, "--shard", shard] for shard in numbered]
    # pure=False: Dask must not reuse the result of an earlier call with the same arguments.
    futures = client.map(_run, commands, folder=here, pure=False)
    try:
        for done, future in enumerate(as_completed(futures), start=1):
            future.result()
            if progress is not None:
                progress(done, shards)
    except BaseException:
        client.cancel(futures)
        raise
    return _run([program, "merge", folder])


def _main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m eomgen.dask")
    parser.add_argument("--scheduler", required=True)
    parser.add_argument("--shards", type=int, required=True)
    parser.add_argument("command", nargs="+")
    given = parser.parse_args()
    try:
        from dask.distributed import Client
    except ImportError:
        print("error: Dask is not installed: pip install 'dask[distributed]'", file=sys.stderr)
        return 1
    program, _, *arguments = given.command

    def tell(done: int, whole: int) -> None:
        if sys.stderr.isatty():
            print(f"\r{done} of {whole} shards", end="\n" if done == whole else "", file=sys.stderr)

    try:
        with Client(given.scheduler, timeout="10s") as client:
            print(sweep(client, arguments, given.shards, program=program, progress=tell), end="")
    except Exception as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(_main())
