"""How results behave near singularities, for extreme values, in other units and over long runs."""
