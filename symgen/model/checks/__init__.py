"""What a model must be beyond well-formed names, and what is special about it."""
