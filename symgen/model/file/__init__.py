"""The model file: text with places, schema, names in scope."""
