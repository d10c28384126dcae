"""Forms: the ways in which u can be computed, each with everything it divides by."""
