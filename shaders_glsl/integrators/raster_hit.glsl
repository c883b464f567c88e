// First surfaces that were rasterised: see raster.frag.

uniform isampler2D raster_hits;  // shape, and the bits of the distance; row 0 on top

Hit raster_hit = Hit(FAR, NO_SHAPE);  // of the pixel, where RASTERS

void read_raster(ivec2 place) {
    if (!RASTERS) return;
    ivec2 found = texelFetch(raster_hits, place - frame.origin, 0).xy;
    raster_hit = Hit(intBitsToFloat(found.y), found.x);
}

// The next surface on a path. The first one is in the raster.
Hit next_hit(Ray ray, int depth) {
    if (RASTERS && depth == 0 && ray.origin_shape == NO_SHAPE) return raster_hit;
    return closest_hit(ray);
}
