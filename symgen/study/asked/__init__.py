"""What a study is asked for: by options, or by a study file with the places of its mistakes."""
