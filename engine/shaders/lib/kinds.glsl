// Kinds of grass: figures that each has stand in vectors, four kinds in each.
#include "engine/declared/grass.py"

#ifndef KINDS
#define KINDS MOST_KINDS  // who is told nothing has room for as many as there can be
#endif
#define GROUPS ((KINDS + 3) / 4)
#define FORMS (2 * KINDS)  // what each kind has grown to, and then what each is to become, if anything
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

// The sum of products, kind by kind.
float weighed(ByKind figures, ByKind weights) {
    float sum = 0.0;
    for (int group = 0; group < GROUPS; group++)
        sum += dot(figures[group], weights[group]);
    return sum;
}

// The figure of a kind that is known only while a pixel is drawn, of figures that it has made out itself: it goes through all, as
// compilers do not agree on how to find one.
float figure_of(ByKind figures, int kind) {
    float found = 0.0;
    for (int other = 0; other < KINDS; other++)
        found = other == kind ? OF(figures, other) : found;
    return found;
}

// The first kind from `kind` on whose figure is above `least`, KINDS if there is none: of many kinds, few are at one place. It goes
// through all as well: where it went on from one to the next until one was found, an NVIDIA H100 drew none where the first was not met.
int next_kind(ByKind figures, float least, int kind) {
    int found = KINDS;
    for (int other = 0; other < KINDS; other++)
        found = other >= kind && OF(figures, other) > least ? min(found, other) : found;
    return found;
}
