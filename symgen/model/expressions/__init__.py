"""The expressions a user writes: grammar, tree, units."""
