"""generated/<model>/files.sha256: the checksum of every file that symgen makes of a model, but of measurements.

    python tools/generated_checksums.py generated MODEL...

Whole folders are kept of a few models; of the others the checksums say whether a change has changed what is made.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from symgen.generation.results import ALL_PARTS, PARTS
from symgen.output.manifest import CHECKSUMS, checksum_of, read_manifest
from symgen.output.write import is_measured

# Folders of what is made only where it is asked for.
ASKED_FOR = frozenset(ALL_PARTS) - frozenset(PARTS)


def checksums_text(files: Mapping[str, str | bytes]) -> str:
    """One line a file as `sha256sum --check` reads it, sorted by path; measurements are left out."""
    bytes_of = {path: text.encode() if isinstance(text, str) else text for path, text in files.items()}
    return listed({path: checksum_of(content) for path, content in bytes_of.items()})


def listed(checksums: Mapping[str, str]) -> str:
    """The lines of checksums by path."""
    return "".join(f"{checksum}  {path}\n" for path, checksum in sorted(checksums.items()) if not is_measured(path))


def main(out: Path, models: list[str]) -> int:
    """Writes the checksums of what was made in the folders of `out`."""
    for model in models:
        made = read_manifest(out / model)
        if made is None:
            print(f"{out / model}: made by no run of symgen here: run `make generated`", file=sys.stderr)
            return 1
        # of runs that were asked for more the rest is no part of what is kept
        usual = {path: checksum for path, checksum in made[1].items() if path.partition("/")[0] not in ASKED_FOR}
        (out / model / CHECKSUMS).write_text(listed(usual))
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
