// The first surface of a pixel, where it was rasterised: entry files read it from the texture that raster.frag fills.

Hit raster_hit = Hit(FAR, NO_SHAPE);

// `found`: shape, and the bits of the distance.
void keep_raster(ivec2 found) {
    raster_hit = Hit(intBitsToFloat(found.y), found.x);
}

// The next surface on a path. The first one is in the raster.
Hit next_hit(Ray ray, int depth) {
    if (RASTERS && depth == 0 && ray.origin_shape == NO_SHAPE) return raster_hit;
    return closest_hit(ray);
}
