"""docs/python.ipynb: the page on symgen in Python as a notebook, its blocks of Python as cells.

`python tools/notebook_page.py` writes it; `--check` exits with 1 where it differs.  Without outputs: whoever opens it
runs it, and a test does.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PAGE, NOTEBOOK = "docs/python.md", "docs/python.ipynb"
BLOCK = re.compile(r"```python\n(.*?)```\n", re.DOTALL)


def notebook(page: str) -> str:
    """The text of the notebook (format 4.5) with the words and the code of a page."""
    cells = [{"id": f"cell-{k}", **cell} for k, cell in enumerate(_cells(page))]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    whole = {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole, indent=1, ensure_ascii=False) + "\n"


def _cells(page: str) -> Iterator[dict[str, Any]]:
    """Words and blocks in turn."""
    for k, text in enumerate(BLOCK.split(page)):
        if not text.strip():
            continue
        source = text.strip("\n").splitlines(keepends=True)
        if k % 2:
            yield {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": source}
        else:
            yield {"cell_type": "markdown", "metadata": {}, "source": source}


def main() -> int:
    """1 where a check finds a difference."""
    made, path = notebook((ROOT / PAGE).read_text(encoding="utf-8")), ROOT / NOTEBOOK
    if "--check" in sys.argv[1:]:
        if path.is_file() and path.read_text(encoding="utf-8") == made:
            return 0
        print(f"{NOTEBOOK}: run `python tools/notebook_page.py`")
        return 1
    path.write_text(made, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
