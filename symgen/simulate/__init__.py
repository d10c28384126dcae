"""`symgen simulate`: the generated forward dynamics integrated from a consistent start, drawn and animated."""
