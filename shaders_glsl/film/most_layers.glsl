// How many layers of light a film keeps at most: paths fill them, and what shows them sums them.

const int MOST_LAYERS = 6;
