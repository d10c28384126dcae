"""The other tools, each given the same model and the methods an expert would hand it."""
