// The mean of what patches hear, for what lies farther off than they do: of some, evenly spread.
uniform sampler2D air;

out vec2 told;

const int LINES = 12;

void main() {
    ivec2 side = textureSize(air, 0);
    vec2 sum = vec2(0.0);
    for (int row = 0; row < LINES; row++)
        for (int column = 0; column < LINES; column++)  // few turns: drivers unroll them, and the texels come together
            sum += texelFetch(air, ivec2(column, row) * side / LINES, 0).xy;
    told = sum / float(LINES * LINES);
}
