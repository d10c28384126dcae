"""The same mechanism written otherwise: in other units, in degrees, by energies, with one constraint more."""
