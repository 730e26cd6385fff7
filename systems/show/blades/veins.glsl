// The middle rib of a blade or a leaf, and the veins beside it, which are seen near by; farther off it is as bright in the mean.

const float RIB = 0.12;         // how wide the rib is, of half the blade
const float RIB_PALE = 0.2;     // how much brighter it is
const float RIB_IN_MEAN = RIB * 1.0645;  // sqrt(pi / ln 2) / 2 is the integral of exp2(-x * x) from 0 on
const float VEINS = 5.0;        // on either side: a whole number, so that they leave the mean as it is
const float VEIN_DARK = 0.07;   // how much darker they are than what is between them is brighter
const float RIB_FROM = 1.5, RIB_ALL = 4.0;    // half the blade's width from which on its rib is seen, and all of it [pixel]
const float VEINS_FROM = 6.0, VEINS_ALL = 12.0;  // and its veins
const float A_TURN = 6.2831853;

// How bright a blade is at a place across it, from -1 to 1, of its colour, where half of it is so many pixels wide. It may have a
// rib, and veins, as far as it is `veined`.
float across_veins(vec2 veined, float beside, float wide) {
    if (wide < RIB_FROM)
        return 1.0;
    float rib = smoothstep(RIB_FROM, RIB_ALL, wide) * RIB_PALE * (exp2(-(beside * beside) / (RIB * RIB)) - RIB_IN_MEAN);
    return 1.0 + veined.x * rib + veined.y * smoothstep(VEINS_FROM, VEINS_ALL, wide) * VEIN_DARK * cos(A_TURN * VEINS * beside);
}
