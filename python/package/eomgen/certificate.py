"""Certificate of a model."""

from __future__ import annotations

from typing import Any, Dict, List


class Certificate:
    """Result of all checks of a model. `document` is the content of `certificate.json`."""

    def __init__(self, document: Dict[str, Any]):
        self.document = document

    @property
    def passed(self) -> bool:
        """True if all checks passed and none was skipped."""
        return bool(self.document["passed"])

    @property
    def verdict(self) -> str:
        """Verdict: "passed", "partial" or "failed"."""
        return str(self.document["verdict"])

    @property
    def checks(self) -> List[Dict[str, Any]]:
        """Checks, each with `name`, `value`, `tolerance`, `passed` and `skipped`."""
        return list(self.document["checks"])

    def __repr__(self) -> str:
        failed = [check["name"] for check in self.checks if not check["passed"]]
        return f"<eomgen.Certificate: {self.verdict}{': ' + ', '.join(failed) if failed else ''}>"
