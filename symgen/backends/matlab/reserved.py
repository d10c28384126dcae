"""Words of MATLAB and of Octave.  None is refused in model files: what is taken gets an ending inside of the files."""

from __future__ import annotations

from symgen.registered import Words, words

_MATLAB = words(
    """break case catch classdef continue else elseif end for function global if otherwise parfor persistent return spmd
    switch try while"""
)
_OCTAVE = words(
    """do endclassdef endenumeration endevents endfor endfunction endif endmethods endparfor endproperties endswitch
    endwhile end_try_catch end_unwind_protect enumeration events methods properties until unwind_protect
    unwind_protect_cleanup"""
)
# Longer names are cut off by MATLAB.
LONGEST_NAME = 63


def is_taken(name: str) -> bool:
    """Whether a name is no identifier in either of them."""
    return name in _MATLAB or name in _OCTAVE or len(name) > LONGEST_NAME or name.startswith("_")


WORDS = Words({}, is_taken)
