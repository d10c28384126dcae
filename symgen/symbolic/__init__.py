"""Hash-consed real scalars: the graph every kernel is derived on; knows no mechanics."""
