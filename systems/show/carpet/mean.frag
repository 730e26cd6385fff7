// Mean message of the patches, over an even sample of them, for what is farther away.
uniform sampler2D air;

out vec2 message;

const int LINES = 12;

void main() {
    ivec2 side = textureSize(air, 0);
    vec2 sum = vec2(0.0);
    for (int row = 0; row < LINES; row++)
        for (int column = 0; column < LINES; column++)  // few turns, which drivers unroll so that texels are fetched together
            sum += texelFetch(air, ivec2(column, row) * side / LINES, 0).xy;
    message = sum / float(LINES * LINES);
}
