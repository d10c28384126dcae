"""Motors of a catalogue for the drives of a study: what each would have to do, and which can."""
