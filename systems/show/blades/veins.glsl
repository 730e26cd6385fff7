// The middle rib of a blade or a leaf, and the veins beside it, as pixels have them in the mean: near by they are seen, and farther off
// a blade is as bright as with them.

const float RIB = 0.12;       // how wide the rib is, of half the blade
const float RIB_PALE = 0.2;   // how much brighter it is
const float VEINS = 5.0;      // on either side: a whole number, so that they leave the mean as it is
const float VEIN_DARK = 0.07; // how much darker they are than what is between them is brighter
const float RIB_FROM = 0.75;  // half the blade's width from which on any of that is seen [pixel]
const float A_TURN = 6.2831853;
const float MEAN_OF_RIB = 1.0644670;  // sqrt(pi / ln 2) / 2, the integral of exp2(-x * x) from 0 on
const float PIXEL_OF_RIB = 0.3398891; // sqrt(ln 2 / 6): a pixel's spread, 1 / sqrt(12), as exp2(-x * x) has it
const float PIXEL_OF_VEINS = 2.3731382;  // pi * pi / (6 ln 2): how fast pixels even waves out

// How bright a blade is at a place across it, from -1 to 1, of its colour, where half of it is so many pixels wide. It may have a
// rib, and veins, as far as it is `veined`.
float across_veins(vec2 veined, float beside, float wide) {
    if (wide < RIB_FROM)
        return 1.0;
    float broad = length(vec2(RIB, PIXEL_OF_RIB / wide)), often = VEINS / wide;
    float rib = RIB_PALE * RIB * (exp2(-(beside * beside) / (broad * broad)) / broad - MEAN_OF_RIB);
    return 1.0 + veined.x * rib + veined.y * VEIN_DARK * exp2(-PIXEL_OF_VEINS * often * often) * cos(A_TURN * VEINS * beside);
}
