"""Progress of long computations: a line in a terminal, a display in a notebook."""

from __future__ import annotations

import sys
import time
from typing import Any, Callable, Optional

from . import _arguments

# Duration of a computation from which on a progress line is shown, s.
PATIENCE = 2.0


class _Line:
    """Line of a terminal or notebook that each new text overwrites."""

    def __init__(self) -> None:
        self._begin = time.monotonic()
        self._display: Any = None
        self._length = 0

    def show(self, text: str) -> None:
        if time.monotonic() - self._begin < PATIENCE:
            return
        if _in_notebook():
            self._in_notebook(text)
        elif sys.stderr is not None and sys.stderr.isatty():
            sys.stderr.write("\r" + text.ljust(self._length))
            sys.stderr.flush()
            self._length = len(text)

    def clear(self) -> None:
        if self._display is not None:
            self._in_notebook("")
        elif self._length:
            sys.stderr.write("\r" + " " * self._length + "\r")
            sys.stderr.flush()

    def _in_notebook(self, text: str) -> None:
        from IPython import display

        content = {"text/plain": text}
        if self._display is None:
            show: Any = display.display
            self._display = show(content, raw=True, display_id=True)
        else:
            self._display.update(content, raw=True)


def _in_notebook() -> bool:
    # A notebook has loaded IPython.
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


class Fraction:
    """Reports the completed fraction, 0 to 1, to `progress`, or shows it on a line."""

    def __init__(self, what: str, span: tuple[float, float], progress: Optional[Callable[[float], object]]):
        self._what = what
        self._begin, self._end = span
        self._progress = _arguments.function("progress", progress, "a function of the completed fraction")
        self._line = _Line()

    def __enter__(self) -> "Fraction":
        return self

    def __exit__(self, *_: object) -> None:
        self._line.clear()

    def tell(self, done: float) -> None:
        whole = self._end - self._begin
        part = min(max((done - self._begin) / whole, 0.0), 1.0) if whole > 0.0 else 1.0
        if self._progress is not None:
            self._progress(part)
        else:
            self._line.show(f"{self._what}: {100 * part:.0f} %")


class Lines:
    """Reports messages to `progress`, or shows the last one on a line."""

    def __init__(self, progress: Optional[Callable[[str], object]]):
        self._progress = _arguments.function("progress", progress, "a function of a message")
        self._line = _Line()

    def __enter__(self) -> "Lines":
        return self

    def __exit__(self, *_: object) -> None:
        self._line.clear()

    def tell(self, line: str) -> None:
        if self._progress is not None:
            self._progress(line)
        else:
            self._line.show(line)
