// Counter-based random numbers, bit for bit those of engine/random.py.

uint scramble(uint x) {
    x += 0x9E3779B9u;
    x = (x ^ (x >> 16u)) * 0x7FEB352Du;
    x = (x ^ (x >> 15u)) * 0x846CA68Bu;
    return x ^ (x >> 16u);
}

uint hash3(int seed, int a, int b) {
    return scramble(uint(b) ^ scramble(uint(a) ^ scramble(uint(seed))));
}

uint stream(uint hashed, int number) {
    return scramble(hashed ^ scramble(uint(number)));
}

// A number for hashing a place on the ground.
int place_number(vec2 place) {
    return floatBitsToInt(place.x) * 3 + floatBitsToInt(place.y);
}

const float STEP = 1.0 / 16777216.0;  // of 24 bits

float unit(uint hashed) {
    return float(hashed >> 8u) * STEP;
}
