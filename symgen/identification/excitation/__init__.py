"""Motions to identify by: designed within what the machine can do, so that a log of them shows each parameter."""
