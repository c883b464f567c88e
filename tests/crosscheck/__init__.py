"""Other renderers show the same pictures."""
