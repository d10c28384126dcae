"""`study.html`: settings, what is worst and where, and the pictures, in one file that needs nothing else."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape

from symgen.study.shown.pictures import StudyPicture

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 60em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
table { border-collapse: collapse; } td, th { text-align: left; vertical-align: top; padding: 0.2em 1.2em 0.2em 0; }
th { font-weight: 600; border-bottom: 1px solid #ccc; } tr + tr td { border-top: 1px solid #eee; }
td.number { text-align: right; font-variant-numeric: tabular-nums; } figure { margin: 1em 0 2em; }
figure img { max-width: 100%; } figcaption { color: #555; } .scroll { overflow-x: auto; }
"""


def study_page(
    title: str,
    settings: Sequence[tuple[str, str]],
    tables: Iterable[tuple[str, Sequence[str], Sequence[Sequence[str]]]],
    pictures: Iterable[StudyPicture],
) -> str:
    """The page; `tables` are headings with the names of their columns and their rows."""
    parts = [f"<h1>{escape(title)}</h1>", _table((), settings)]
    for heading, columns, rows in tables:
        if rows:
            parts.append(f"<h2>{_heading(heading)}</h2>{_table(columns, rows)}")
    parts += [_figure(picture) for picture in pictures]
    body = "\n".join(parts)
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
    head = f'<html lang="en"><head>{head}<style>{_STYLE}</style></head>'
    return f"<!DOCTYPE html>\n{head}\n<body>\n{body}\n</body></html>\n"


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = f"<tr>{''.join(f'<th>{escape(name)}</th>' for name in columns)}</tr>" if columns else ""
    lines = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    return f'<div class="scroll"><table>{head}{lines}</table></div>'


def _figure(picture: StudyPicture) -> str:
    """Images keep the names inside of one picture from those of the next."""
    data = b64encode(picture.text.encode()).decode()
    caption = f"<figcaption>{escape(picture.caption)}</figcaption>" if picture.caption else ""
    heading = f"<h2>{_heading(picture.title)}</h2>"
    image = f'<img alt="{escape(picture.title)}" src="data:image/svg+xml;base64,{data}">'
    return f"{heading}<figure>{image}{caption}</figure>"


def _heading(text: str) -> str:
    """With a capital."""
    return escape(text[:1].upper() + text[1:])
