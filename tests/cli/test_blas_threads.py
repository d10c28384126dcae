"""Thousands of small systems are solved in turn: threads of a BLAS take several times as long over them."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

# the environment as NumPy meets it, which a command loads where it needs it
SHOWN = """
import os, sys
from symgen.cli.main import main
sys.argv = ["symgen", "schema"]
assert "numpy" not in sys.modules
main()
print("threads", os.environ["OPENBLAS_NUM_THREADS"], file=sys.stderr)
"""


@pytest.mark.parametrize(("given", "taken"), [(None, "1"), ("3", "3")])
def test_a_command_takes_one_thread_unless_its_user_says_otherwise(given: str | None, taken: str) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    environment |= {"OPENBLAS_NUM_THREADS": given} if given else {}
    run = subprocess.run([sys.executable, "-c", SHOWN], env=environment, capture_output=True, text=True, check=True)
    assert run.stderr.strip() == f"threads {taken}"
