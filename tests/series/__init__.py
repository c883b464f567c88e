"""Series of pictures: animations, turntables, sweeps, and the files made of them."""
