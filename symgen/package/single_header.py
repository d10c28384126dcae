"""Header and source as one file: declarations always, definitions where a macro asks for them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import PurePosixPath

from symgen.naming import macro_name


def single_headers(c_files: Mapping[str, str], without: Collection[str] = ()) -> dict[str, str]:
    """The single header of every header/source pair of `c/`, by file name, but for headers that are left out.

    `#define <STEM>_IMPLEMENTATION` before the inclusion, in one source file, brings the definitions.
    """
    return {
        PurePosixPath(path).name: _merged(PurePosixPath(path).stem, header, c_files[path[:-2] + ".c"])
        for path, header in c_files.items()
        if path.endswith(".h") and path not in without
    }


def implementation_macro(stem: str) -> str:
    """The macro that brings the definitions of a single header."""
    return f"{macro_name(stem)}_IMPLEMENTATION"


def _merged(stem: str, header: str, source: str) -> str:
    own = f'#include "{stem}.h"\n'
    body = source.replace(own, "", 1)
    macro = implementation_macro(stem)
    # a guard of its own: the header may have been included before without definitions
    return (
        f"{header}\n"
        f"/* Definitions: in one source file `#define {macro}` before this header is included. */\n"
        f"#if defined({macro}) && !defined({macro}_DONE)\n"
        f"#define {macro}_DONE\n\n{body}\n#endif\n"
    )
