"""Forms: the ways in which one quantity can be computed, each with everything it divides by."""
