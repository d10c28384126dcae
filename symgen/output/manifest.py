"""The lists of the files of a folder that symgen made, with their checksums as `sha256sum --check` reads them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

FILES = ".symgen-files"
CHECKSUMS = "files.sha256"  # the same for a repository, without measurements: tools/generated_checksums.py writes it
_HEAD = "# What symgen made of the model {name}; other files are never replaced or removed.\n"
_NAME = re.compile(r"# What symgen made of the model (\w+);")
_LINE = re.compile(r"([0-9a-f]{64})  (.+)")


def is_inside(path: str) -> bool:
    """Whether a relative POSIX path names a file inside its folder that is none of symgen's bookkeeping."""
    parts = PurePosixPath(path).parts
    return bool(parts) and not (path.startswith("/") or ".." in parts or "\\" in path or parts[0].startswith("."))


def manifest_text(name: str, checksums: Mapping[str, str]) -> str:
    """The list of a model's folder: checksums by path."""
    lines = [f"{checksum}  {path}\n" for path, checksum in sorted(checksums.items())]
    return "".join([_HEAD.format(name=name), *lines])


def read_manifest(directory: Path) -> tuple[str, dict[str, str]] | None:
    """The model and the checksums by path; None where there is no list."""
    try:
        text = (directory / FILES).read_text(encoding="utf-8", errors="replace")
    except (FileNotFoundError, NotADirectoryError):
        return None
    name = _NAME.match(text)
    return name.group(1) if name else "", _by_path(text)


def read_checksums(directory: Path) -> dict[str, str]:
    """Those that a repository keeps, by path; none where it keeps none."""
    try:
        return _by_path((directory / CHECKSUMS).read_text(encoding="utf-8", errors="replace"))
    except (FileNotFoundError, NotADirectoryError):
        return {}


def _by_path(text: str) -> dict[str, str]:
    entries = (line.groups() for row in text.splitlines() if (line := _LINE.fullmatch(row)))
    return {path: checksum for checksum, path in entries if is_inside(path)}


def checksum_of(content: bytes) -> str:
    """SHA-256 of a file's content, in hexadecimal digits."""
    import hashlib

    return hashlib.sha256(content).hexdigest()
