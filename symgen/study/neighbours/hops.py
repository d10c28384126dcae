"""C that goes from one configuration to one other place, for many of them: each hop has a start of its own.

A hop is the straight way of a walk (`study_leg_...` of the loops), without the ways beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import dedent

from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel
from symgen.model.model import Model
from symgen.study.loops import is_walked


def hops_source(model: Model, kernels: Sequence[Kernel]) -> str:
    """Functions to stand behind the loops in their file."""
    return "\n".join(_hops(model, one) for one in kernels if is_walked(one))


def hops_name(quantity: str) -> str:
    """The function that hops."""
    return f"study_hops_{quantity}"


def _hops(model: Model, kernel: Kernel) -> str:
    """All arrays are `[hop][component]`; of a hop that does not end q is NaN."""
    given, q = array_arguments(kernel)
    number = max(1, len(model.parameters))
    return dedent(f"""\

        void {hops_name(kernel.name)}(size_t hops, const double *p_start, const double *p_end, const double *x_start,
                const double *x_end, const double *q_start, double *q_end)
        {{
            for (size_t hop = 0; hop < hops; ++hop) {{
                double *here = q_end + hop * {q.length};
                for (size_t i = 0; i < {q.length}; ++i) {{
                    here[i] = q_start[hop * {q.length} + i];
                }}
                const int code = study_leg_{kernel.name}(p_start + hop * {number}, p_end + hop * {number},
                    x_start + hop * {given.length}, x_end + hop * {given.length}, here);
                for (size_t i = 0; code && i < {q.length}; ++i) {{
                    here[i] = (double)NAN;
                }}
            }}
        }}
        """)
