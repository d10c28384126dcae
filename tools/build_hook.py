"""Compiles the templates while symgen is built or installed, a wheel and an editable install alike."""

from __future__ import annotations

import sys
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class TemplatesHook(BuildHookInterface[Any]):
    """Called by hatchling."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Writes `templates/compiled`, which travels with the templates into every kind of build."""
        del version, build_data
        sys.path.insert(0, self.root)
        try:
            from symgen.backends.render import compile_all

            compile_all()
        finally:
            sys.path.remove(self.root)
