"""Methods for the inputs u."""
