// The numbers of AOVs.

const int NO_AOV = 0;
const int ALBEDO = 1;
const int NORMAL = 2;
const int DEPTH = 3;
const int POSITION = 4;
const int OBJECT = 5;
const int BOUNCES = 6;
const int EMISSION = 7;
const int DIRECT = 8;
const int INDIRECT = 9;
const int DIFFUSE = 10;
const int GLOSSY = 11;
const int TRANSMISSION = 12;
const int VOLUME = 13;
