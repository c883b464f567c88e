// Numbers in the record of a path.

// Events at a vertex.
const int EVENT_ENDED = 0;         // nothing more: the path ends there
const int EVENT_SENT = 1;          // sent by the camera
const int EVENT_REFLECTED = 2;     // scattered to the side that it came from
const int EVENT_CROSSED = 3;       // scattered through the surface
const int EVENT_PASSED_HOLE = 4;   // went on through a hole of the surface
const int EVENT_PASSED_GLASS = 5;  // went on through a surface that lies in another glass

// The strategy that found light.
const int BY_SCATTERING = 0;  // the path met it
const int BY_SAMPLING = 1;    // a point or a direction was sampled on it
const int BY_PARTICLE = 2;    // a particle from there was linked to the camera

// The source of light that comes from no object of the scene.
const int FROM_BACKGROUND = -1;
const int FROM_SUN = -2;
const int FROM_MEDIUM = -3;  // minus the row of the medium; also the object of a vertex where a medium scatters

// Why a path ended.
const int END_LEFT_SCENE = 1;
const int END_BOUNCE_LIMIT = 2;
const int END_ABSORBED = 3;
const int END_BELOW_SURFACE = 4;  // the direction lies above one of the shading and the true normal and below the other
const int END_BY_ROULETTE = 5;
const int END_CUT_LOOP = 6;       // the driver cut a loop: the sample is lost
const int END_LINKED = 7;         // of a particle: the rest of its path adds nothing to the pixel
