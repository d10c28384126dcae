"""Generated code against the reference: states, tolerance, laws, certificate."""
