// The picture in tiles; a dispatch takes some of them.

const int TILE = 8;  // pixels along an edge

// The pixel in the corner of a tile. Tiles are numbered along rows, `tile_stride` apart. So the tiles of
// one dispatch lie all over the picture, and each dispatch costs about the same.
ivec2 tile_corner(ivec2 picture, int number) {
    ivec2 tiles = (picture + TILE - 1) / TILE;
    uint index = uint(number) * uint(frame.tile_stride) % uint(tiles.x * tiles.y);
    int tile = int(index);
    return TILE * ivec2(tile % tiles.x, tile / tiles.x);
}
