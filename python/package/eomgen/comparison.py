"""Comparison of a model with records."""

from __future__ import annotations

import json
import os
import time
from typing import Any, Callable, Dict, Mapping, Optional, Union

from . import _arguments, _native
from ._files import FOLDER, write_all
from ._progress import Lines

# Names of the files of a comparison.
DOCUMENT, PAGE = "comparison.json", "report.html"


class Comparison:
    """Result of a comparison. `document` is the content of `comparison.json`, `report` the report page (HTML)."""

    def __init__(self, document: Dict[str, Any], report: str):
        self.document, self.report = document, report

    @property
    def verdict(self) -> str:
        """Verdict, one word."""
        return str(self.document["verdict"])

    @property
    def summary(self) -> str:
        """Summary as text."""
        return str(self.document["summary"])

    @property
    def gap(self) -> Mapping[str, Any]:
        """RMS residual of each channel and its noise floor, in the channel's SI unit."""
        return dict(self.document["gap"])

    @property
    def where(self) -> str:
        """Equations, times and conditions in which model and records disagree, as text."""
        return str(self.document["where"])

    def write(self, out: Union[str, "os.PathLike[str]"]) -> None:
        """Writes `comparison.json` and `report.html` to a folder."""
        document = json.dumps(self.document, indent=2, ensure_ascii=False, sort_keys=True) + "\n"
        texts = {PAGE: self.report, DOCUMENT: document}
        write_all(out, {name: text.encode("utf-8") for name, text in texts.items()})

    def __repr__(self) -> str:
        return f"<eomgen.Comparison: {self.verdict}>"


def compare(
    native: _native.Model,
    dataset: Union[str, "os.PathLike[str]"],
    out: Union[str, "os.PathLike[str]", None],
    seed: int,
    progress: Optional[Callable[[str], object]],
) -> Comparison:
    """Compares a model with records. See `Model.compare`."""
    path = _arguments.path("dataset", dataset, "the path of a dataset file")
    folder = None if out is None else _arguments.path("out", out, FOLDER)
    seed = _arguments.whole("seed", seed)
    begin = time.monotonic()
    with Lines(progress) as lines:
        document, report = _native.compare(native, path, seed, lines.tell)
    found = Comparison(json.loads(document), report)
    found.document["seconds"] = time.monotonic() - begin
    if folder is not None:
        found.write(folder)
    return found
