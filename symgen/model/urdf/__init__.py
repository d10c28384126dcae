"""Robot descriptions as blocks of the model language."""
