"""The steps of a run: draft, verification's consequences, results."""
