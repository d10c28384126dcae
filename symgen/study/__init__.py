"""`symgen study`: quantities of a model over grids and samples of parameters and places, reduced and mapped."""
