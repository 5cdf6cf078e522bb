/* What a step of a contact costs under each law and option, on a packed bed at rest. */
#ifndef TREMIE_CHARTS_BED_H
#define TREMIE_CHARTS_BED_H

enum { BED_VARIANTS_MAX = 12 };

struct bed_variant {
    const char *name;
    const char *material; /* YAML, more keys of the material; may be empty */
    const char *pair;     /* YAML, the keys of its pair with itself */
    const char *contact;  /* YAML, more keys of `contact`; may be empty */
};

struct bed_cost {
    int n_contacts;     /* touching, with walls */
    double step;        /* CPU time of a whole step over n_contacts [ns] */
    double ratio;       /* of `step` to the first variant's, median of rounds [-] */
    double ratio_pairs; /* the same of the time in the laws of pairs alone, by wall clock [-] */
};

/* Lets a bed settle, then measures each variant on it in turns; a file of spheres goes to the
 * folder `work`. */
void bed_measure(int n, const struct bed_variant *variants, const char *work,
                 struct bed_cost *costs);

#endif
