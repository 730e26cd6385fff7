// The midrib of a blade or a leaf, and the veins beside it, averaged over pixels: they show near by and leave the mean brightness as
// it is farther off.

const float RIB = 0.12;       // width of the rib, relative to half the blade's
const float RIB_PALE = 0.2;   // relative brightness of the rib over the blade's
const float VEINS = 5.0;      // number of veins on either side: a whole one, so that they keep the mean
const float VEIN_DARK = 0.07; // amplitude of the veins' brightness
const float RIB_FROM = 0.75;  // half the blade's width from which on rib and veins show [pixel]
const float A_TURN = 6.2831853;
const float MEAN_OF_RIB = 1.0644670;  // sqrt(pi / ln 2) / 2, the integral of exp2(-x * x) from 0 on
const float PIXEL_OF_RIB = 0.3398891; // sqrt(ln 2 / 6): width of the exp2(-x * x) whose standard deviation is a pixel's, 1 / sqrt(12)
const float PIXEL_OF_VEINS = 2.3731382;  // pi * pi / (6 ln 2): rate at which averaging over a pixel damps waves

// Relative brightness of a blade at place `across`, from -1 to 1, where half its width is `half_wide` pixels. `veined` is the
// visibility of the rib, and of the veins.
float vein_brightness(vec2 veined, float across, float half_wide) {
    if (!(half_wide >= RIB_FROM))  // so too where it is no number, as of ribbons that Mesa clips at the picture's corners
        return 1.0;
    float broad = length(vec2(RIB, PIXEL_OF_RIB / half_wide)), frequency = VEINS / half_wide;
    float rib = RIB_PALE * RIB * (exp2(-(across * across) / (broad * broad)) / broad - MEAN_OF_RIB);
    return 1.0 + veined.x * rib + veined.y * VEIN_DARK * exp2(-PIXEL_OF_VEINS * frequency * frequency) * cos(A_TURN * VEINS * across);
}
