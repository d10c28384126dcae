"""Pages of the documentation whose blocks run one after the other in a folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"


class Page:
    """A page, and the folder in which its blocks run."""

    def __init__(self, name: str, folder: Path) -> None:
        self.text, self.folder = (DOCS / name).read_text(encoding="utf-8"), folder
        commands = Path(sys.executable).parent
        self._environment = {**os.environ, "PATH": f"{commands}{os.pathsep}{os.environ['PATH']}"}

    def blocks(self, language: str) -> list[str]:
        """Those of a language, in their order."""
        return re.findall(rf"```{language}\n(.*?)```", self.text, re.DOTALL)

    def write(self, name: str, text: str) -> None:
        """A file of the folder."""
        (self.folder / name).write_text(text, encoding="utf-8")

    def run(self, *command: str, code: int = 0) -> subprocess.CompletedProcess[str]:
        """What a command of the page does."""
        made = subprocess.run(
            command, cwd=self.folder, env=self._environment, capture_output=True, text=True, check=False
        )
        assert made.returncode == code, made.stderr
        return made
