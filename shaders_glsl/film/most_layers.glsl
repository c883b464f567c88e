// The most layers of light that a film keeps: paths fill them, and passes that show them sum them.

const int MOST_LAYERS = 6;
