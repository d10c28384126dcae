"""MJCF files as blocks of the model language."""
