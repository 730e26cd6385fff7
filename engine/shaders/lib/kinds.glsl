// Values by kind of grass, in vectors of four kinds.
#include "engine/declared/grass.py"

#ifndef KINDS
#define KINDS MOST_KINDS  // without a number, there is room for all
#endif
#define GROUPS ((KINDS + 3) / 4)
#define FORMS (2 * KINDS)  // each kind's present form, then the form that it changes into, if any
#define ByKind vec4[GROUPS]
#if KINDS > 4
#define GROUP(kind) ((kind) >> 2)
#define IN_GROUP(kind) ((kind) & 3)
#else
#define GROUP(kind) 0
#define IN_GROUP(kind) (kind)
#endif
#define OF(figures, kind) figures[GROUP(kind)][IN_GROUP(kind)]

ByKind all_kinds(float figure) {
    ByKind all;
    for (int group = 0; group < GROUPS; group++)
        all[group] = vec4(figure);
    return all;
}

float total(ByKind figures) {
    float sum = 0.0;
    for (int group = 0; group < GROUPS; group++)
        sum += dot(figures[group], vec4(1.0));
    return sum;
}

// Dot product over kinds.
float weighted_sum(ByKind figures, ByKind weights) {
    float sum = 0.0;
    for (int group = 0; group < GROUPS; group++)
        sum += dot(figures[group], weights[group]);
    return sum;
}

// The value of a kind whose index is not uniform, from values computed in the shader. It loops over all kinds, as compilers differ on
// dynamic indexing.
float figure_at(ByKind figures, int kind) {
    float found = 0.0;
    for (int other = 0; other < KINDS; other++)
        found = other == kind ? OF(figures, other) : found;
    return found;
}

// The first kind from `kind` on whose value is above `least`, or KINDS. It loops over all kinds, too: a loop that ended at the first
// match drew nothing on an NVIDIA H100 wherever kind 0 was absent.
int next_kind(ByKind figures, float least, int kind) {
    int found = KINDS;
    for (int other = 0; other < KINDS; other++)
        found = other >= kind && OF(figures, other) > least ? min(found, other) : found;
    return found;
}
