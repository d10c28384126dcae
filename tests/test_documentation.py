"""README.md and docs/ say what symgen does now."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_marked_blocks_and_generated_pages_are_current() -> None:
    command = [sys.executable, "tools/fill_readme.py", "--check"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
