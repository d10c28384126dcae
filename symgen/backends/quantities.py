"""What readers of generated code see of each quantity: the name of its output argument and one line of meaning."""

from __future__ import annotations

from symgen.ir.kernel import Kernel
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.model.quantities import GIVEN_MOTIONS, GIVEN_PLACES, MAIN, ROWS

# Those with a kernel for many states: what trajectories, sampling and simulations evaluate by the million.
BATCHED = (*MAIN, *GIVEN_PLACES, *GIVEN_MOTIONS)
# Those with kernels that take parameters prepared, and sines from the caller: what a control loop repeats.
IN_FORMS = MAIN


def output_argument(quantity: str) -> str:
    """The name of the output argument of a quantity."""
    return ROWS[quantity].result if quantity in ROWS else "result"


def meaning(kernel: Kernel) -> str:
    """One line on a quantity: symbol, description, equation of the paper, what is to be known of this system."""
    known = ROWS.get(kernel.name)
    if known is None:
        return kernel.name.replace("_", " ")
    line = f"{known.symbol}: {known.description}" + (f", {known.equation}" if known.equation else "")
    digits = "; works with twice the digits" if works_with_pairs(kernel) else ""
    return line + digits + (f"; {kernel.remark}" if kernel.remark else "")
