"""What keeps a model's folder whole: a lock, a journal of the switch, and a list of the files that symgen made."""
