"""Files of results."""

from __future__ import annotations

import os
from pathlib import Path
from typing import List, Mapping, Union

from . import _arguments

# Description of `out`, for messages.
FOLDER = "the path of a folder"


def write_all(out: Union[str, "os.PathLike[str]"], files: Mapping[str, bytes]) -> List[Path]:
    """Writes files to a folder and returns their paths. A file replaces an earlier one only when it is complete."""
    folder = Path(_arguments.path("out", out, FOLDER))
    folder.mkdir(parents=True, exist_ok=True)
    for name, contents in files.items():
        temporary = folder / f".{name}.part"
        try:
            temporary.write_bytes(contents)
            os.replace(temporary, folder / name)
        finally:
            temporary.unlink(missing_ok=True)
    return [folder / name for name in files]
