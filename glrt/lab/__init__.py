"""Experiments and exhibits over the renderer."""
