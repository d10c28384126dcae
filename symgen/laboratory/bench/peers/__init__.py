"""The other tools, each given the same model and the forms an expert would hand it."""
