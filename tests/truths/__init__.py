"""Pictures whose right values are known."""
