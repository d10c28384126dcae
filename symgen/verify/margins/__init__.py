"""How far from the states of a verification a kernel may be before it loses digits."""
