"""Scene files made by chance: what they must never do, and programs that make many of them."""
