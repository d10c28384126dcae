"""`symgen explain MODEL.yaml base_parameters`: which combinations of inertial parameters count."""

from __future__ import annotations

import sys
from pathlib import Path

from symgen.cli.outcome import DONE, MODEL_WRONG


def explain_base_parameters(path: Path) -> int:
    """Prints them; 0, or 1 where there are none.  Raises ModelError for mistakes in the file."""
    from symgen.identification.base_parameters import NoBodiesError, base_parameters
    from symgen.identification.motion_states import NoMotionError
    from symgen.identification.text import base_parameters_text
    from symgen.model.load import load_model

    model = load_model(path)
    try:
        text = base_parameters_text(base_parameters(model))
    except NoBodiesError:
        print(f"{path}: base parameters are those of `bodies`, of which the model has none", file=sys.stderr)
        return MODEL_WRONG
    except NoMotionError:
        print(f"{path}: no regular motion was found at which parameters could be told apart", file=sys.stderr)
        return MODEL_WRONG
    print(text)
    return DONE
