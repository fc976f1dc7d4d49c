"""Discovery of effects that a model lacks."""

from __future__ import annotations

import json
import os
import time
from typing import Any, Callable, Dict, List, Mapping, Optional, Union

from . import _arguments, _native
from ._files import FOLDER, write_all
from ._progress import Lines
from .model import Model, load

__all__ = ["Discovery", "discover"]

# Names of the files of a discovery.
DOCUMENT, EXTENDED, PAGE = "discovery.json", "extended.toml", "report.html"


class Discovery:
    """Result of a discovery.

    verdict: "effects_found", "no_significant_gap" or "unexplained". effects: accepted effects, by decreasing
    reduction of the residual, each a dictionary with `effect`, `on`, `status` ("named", "class",
    "provisional" or "empirical"), `equivalent`, `parameters` (names to `value`, `sd`, `unit`) and `term`.
    document: content of `discovery.json`. extended: text of the extended specification. report: report page
    (HTML). experiments: proposed experiments, texts of CSV files by name, with the columns `t` and the inputs
    in the dataset's units.
    """

    def __init__(
        self,
        document: Dict[str, Any],
        extended: str,
        report: str,
        experiments: Mapping[str, str],
        order: Optional[int],
    ):
        self.document, self.extended, self.report = document, extended, report
        self.experiments = dict(experiments)
        self._order = order

    @property
    def verdict(self) -> str:
        """Verdict, one word."""
        return str(self.document["verdict"])

    @property
    def effects(self) -> List[Dict[str, Any]]:
        """Accepted effects."""
        return list(self.document["effects"])

    @property
    def summary(self) -> str:
        """Summary as text. Its first sentence reports a large remaining residual."""
        return str(self.document["summary"])

    @property
    def notes(self) -> List[str]:
        """Remarks on the records, and on fitted values at their bounds."""
        return list(self.document["notes"])

    @property
    def gap(self) -> Mapping[str, Any]:
        """RMS residual of each channel before and after, and its noise floor, in the channel's SI unit."""
        return dict(self.document["gap"])

    @property
    def where(self) -> str:
        """Equations, times and conditions in which model and records disagree, as text."""
        return str(self.document["where"])

    @property
    def model(self) -> Model:
        """Extended model."""
        return load(self.extended, self._order)

    def write(self, out: Union[str, "os.PathLike[str]"]) -> None:
        """Writes `discovery.json`, `extended.toml`, `report.html` and the experiments to a folder. Each file
        replaces an earlier one only when it is complete.
        """
        document = json.dumps(self.document, indent=2, ensure_ascii=False, sort_keys=True) + "\n"
        texts = [(EXTENDED, self.extended), (PAGE, self.report), *self.experiments.items()]
        files = [*texts, (DOCUMENT, document)]
        write_all(out, {name: text.encode("utf-8") for name, text in files})

    def __repr__(self) -> str:
        found = ", ".join(f"{effect['effect']} on {effect['on']}" for effect in self.effects)
        return f"<eomgen.Discovery: {self.verdict}{': ' + found if found else ''}>"

    def _repr_html_(self) -> str:
        # The frame separates the styles of the report from those of the notebook.
        page = self.report.replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 40em; border: 0"></iframe>'


def discover(
    model: Model,
    dataset: Union[str, "os.PathLike[str]"],
    out: Union[str, "os.PathLike[str]", None] = None,
    *,
    seed: int = 1,
    progress: Optional[Callable[[str], object]] = None,
) -> Discovery:
    """Finds effects that a model lacks, by comparison with measured records.

    dataset: path of the dataset file. out: folder for `discovery.json`, `extended.toml`, `report.html` and
    proposed experiments; None writes no files. seed: seed of the noise in the bootstrap; equal seeds give equal
    results. progress: function that is called with each progress message. Default: terminals and notebooks show
    the last message after two seconds.

    Raises SpecificationError for an invalid dataset file, ValueError for invalid records, and DiscoveryError
    if the model cannot be simulated over the records. Ctrl-C interrupts the search.
    """
    if not isinstance(model, Model):
        raise TypeError(_arguments.rejected("model", model, "a model from eomgen.load()"))
    path = _arguments.path("dataset", dataset, "the path of a dataset file")
    folder = None if out is None else _arguments.path("out", out, FOLDER)
    seed = _arguments.whole("seed", seed)
    begin = time.monotonic()
    with Lines(progress) as lines:
        document, extended, report, experiments = _native.discover(
            model._native, path, seed, lines.tell
        )
    found = Discovery(
        json.loads(document), extended, report, dict(experiments), model._native.order
    )
    found.document["seconds"] = time.monotonic() - begin
    if folder is not None:
        found.write(folder)
    return found
