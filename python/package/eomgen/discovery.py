"""What a model lacks of what measured records show."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Union

from . import _arguments, _native
from ._progress import Lines
from .model import Model, load

__all__ = ["Discovery", "discover"]

# The names under which a discovery is written to a folder.
DOCUMENT, EXTENDED, PAGE = "discovery.json", "extended.toml", "report.html"


class Discovery:
    """What a search came to.

    verdict: "effects_found", "no_significant_gap" or "unexplained". effects: what was accepted, by
    decreasing gap closed, each a dictionary with `effect`, `on`, `status` ("named", "class",
    "provisional" or "empirical"), `equivalent`, `parameters` (names to `value`, `sd`, `unit`),
    `term`. document: all of `discovery.json`.
    extended: the text of the specification with what was found; report: the page for people, HTML.
    experiments: what to play next, texts of CSV files by their names, with the columns `t` and the
    inputs in the dataset's units.
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
        """The verdict in a word."""
        return str(self.document["verdict"])

    @property
    def effects(self) -> List[Dict[str, Any]]:
        """What was accepted."""
        return list(self.document["effects"])

    @property
    def summary(self) -> str:
        """The answer in words; where much is left, the first sentence says so."""
        return str(self.document["summary"])

    @property
    def notes(self) -> List[str]:
        """What is worth a remark: of the records, and of what was fitted as far off as it may be."""
        return list(self.document["notes"])

    @property
    def gap(self) -> Mapping[str, Any]:
        """The gap of each channel before and after, and the floor, in the channel's SI unit."""
        return dict(self.document["gap"])

    @property
    def where(self) -> str:
        """Where model and records disagree, in sentences."""
        return str(self.document["where"])

    @property
    def model(self) -> Model:
        """The model with what was found."""
        return load(self.extended, self._order)

    def write(self, out: Union[str, "os.PathLike[str]"]) -> None:
        """Writes `discovery.json`, `extended.toml`, `report.html` and the experiments into a folder,
        each whole or not at all.
        """
        folder = Path(out)
        folder.mkdir(parents=True, exist_ok=True)
        document = json.dumps(self.document, indent=2, ensure_ascii=False, sort_keys=True) + "\n"
        texts = [(EXTENDED, self.extended), (PAGE, self.report), *self.experiments.items()]
        for name, text in [*texts, (DOCUMENT, document)]:
            beside = folder / f".{name}.part"
            try:
                beside.write_bytes(text.encode("utf-8"))
                os.replace(beside, folder / name)
            finally:
                beside.unlink(missing_ok=True)

    def __repr__(self) -> str:
        found = ", ".join(f"{effect['effect']} on {effect['on']}" for effect in self.effects)
        return f"<eomgen.Discovery: {self.verdict}{': ' + found if found else ''}>"

    def _repr_html_(self) -> str:
        # A page of its own, whose style is not the notebook's.
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
    """Finds what a model lacks of what measured records show, and names it.

    dataset: the path of a dataset's file. out: a folder that is to hold `discovery.json`,
    `extended.toml`, `report.html` and experiments to be played, or None. seed: draws the noise of the bootstrap; the same seed
    gives the same result. progress: called with each line on what is being done; by default the
    last one is shown in terminals and notebooks once it takes longer than two seconds.

    Raises SpecificationError for a dataset file that is wrong, ValueError for records that are, and
    DiscoveryError where the model does not run through them. Ctrl-C stops it.
    """
    if not isinstance(model, Model):
        raise TypeError(f"expected a model, as load() makes it, not {type(model).__name__}")
    seed = _arguments.whole("seed", seed)
    begin = time.monotonic()
    with Lines(progress) as lines:
        document, extended, report, experiments = _native.discover(
            model._native, os.fspath(dataset), seed, lines.tell
        )
    found = Discovery(
        json.loads(document), extended, report, dict(experiments), model._native.order
    )
    found.document["seconds"] = time.monotonic() - begin
    if out is not None:
        found.write(out)
    return found
