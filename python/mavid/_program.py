"""The program, and how it is called."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any, Union

Word = Union[str, int, float, "os.PathLike[str]"]

# done; done with loss (the document says which); done, and something changed
_DONE = (0, 3, 4)
# as a shell says that there is no such program
_NOT_FOUND = 127


class MavidError(RuntimeError):
    """The program has no result, or is not there. `status` is its exit status (127: not there); the message is what it said."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status


def program() -> str:
    """The path of the program: the variable MAVID, the one of this wheel, or the one on the PATH. Raises MavidError where it is not there."""
    if named := os.environ.get("MAVID"):
        if found := shutil.which(named):
            return found
        raise MavidError(
            _NOT_FOUND,
            f"expected the path of the program in the environment variable MAVID, got {named!r}, which is no program that can be run: "
            "correct the variable, or remove it to use the program of the wheel or on the PATH",
        )
    name = "mavid.exe" if sys.platform == "win32" else "mavid"
    schemes = [sysconfig.get_path("scripts")]
    if user := sysconfig.get_preferred_scheme("user"):
        schemes.append(sysconfig.get_path("scripts", scheme=user))
    for folder in schemes:
        if folder and (Path(folder) / name).is_file():
            return str(Path(folder) / name)
    if found := shutil.which(name):
        return found
    raise MavidError(
        _NOT_FOUND,
        f"expected the program {name} in {', '.join(filter(None, schemes))} or on the PATH, found none: install the wheel, or set the "
        "environment variable MAVID to the path of the program",
    )


def run(*arguments: Word) -> dict[str, Any]:
    """Runs `mavid ARGUMENTS --json` and gives its document. Raises MavidError where there is none."""
    words = [program(), *(os.fspath(word) if isinstance(word, os.PathLike) else str(word) for word in arguments)]
    done = subprocess.run([*words, "--json"], capture_output=True, text=True, check=False)
    if done.returncode not in _DONE:
        raise MavidError(done.returncode, done.stderr.strip())
    try:
        document: dict[str, Any] = json.loads(done.stdout)
    except json.JSONDecodeError as error:
        said = done.stdout.strip().splitlines()[:1] or ["nothing"]
        raise MavidError(done.returncode, f"expected a JSON document of {' '.join(words)} --json, got {said[0]!r}") from error
    return document
