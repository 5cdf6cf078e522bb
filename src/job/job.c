/*
 * From a file to a struct job: read the YAML, lay the overrides and a variant of the sweep over
 * it, slip the libraries under it, fill the struct by the schema, check what concerns several
 * keys, and keep only the materials that something is made of.
 *
 * Materials are sorted by name and pairs by material, so the indices that states on disk hold
 * do not depend on the order in a file or on which library gave them.
 */
#include "job/job.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job_check.h"
#include "job/job_keys.h"
#include "job/path_file.h"
#include "job/schema.h"
#include "job/sweep.h"
#include "job/yaml_tree.h"

enum { MAX_CLASSES = 32, MAX_LIBRARIES = 16, KEY_LENGTH = 64 };

/* ------------------------------------------------------------------------------- overrides */

/* Lays one `key=value` over the job; the value's nodes live in `tree`. */
static void override_apply(struct yaml_tree *tree, struct yaml_tree_node *root,
                           const char *text, struct mistakes *mistakes)
{
    char shown[YAML_TREE_SHOWN];
    const char *equals = strchr(text, '=');
    *tree = (struct yaml_tree){0};
    if (equals == NULL || equals == text || equals[1] == '\0') {
        mistakes_add(mistakes, "--set", 1, 1,
                     "'%s' is not key=value; for instance time.end=0.5 is expected",
                     yaml_tree_shown(shown, text));
        return;
    }
    const int column = (int)(equals - text) + 2;
    if (!yaml_tree_parse(tree, "--set", column, equals + 1, strlen(equals + 1), mistakes))
        return;
    char *keys = array_string(text);
    keys[equals - text] = '\0';
    const struct yaml_tree_node place = {.file = "--set", .line = 1, .column = 1};
    yaml_tree_put(tree, root, keys, tree->root, &place, mistakes);
    free(keys);
}

/* ------------------------------------------------------------------------------- libraries */

/* Appends to a mapping what a library's mapping has and it has not; mappings in both are
 * merged. */
static void mapping_merge(struct yaml_tree_node *own, const struct yaml_tree_node *library)
{
    struct yaml_tree_node *next;
    if (own->kind != YAML_TREE_MAPPING || library->kind != YAML_TREE_MAPPING)
        return;
    for (struct yaml_tree_node *child = library->first; child != NULL; child = next) {
        next = child->next;
        struct yaml_tree_node *found = yaml_tree_find(own, child->key);
        if (found == NULL)
            yaml_tree_append(own, child->key, child);
        else
            mapping_merge(found, child);
    }
}

/* Do two pairs name the same materials in different files? */
static bool pair_is_replaced(const struct yaml_tree_node *own,
                             const struct yaml_tree_node *library)
{
    const struct yaml_tree_node *p = yaml_tree_find(own, "between");
    const struct yaml_tree_node *q = yaml_tree_find(library, "between");
    if (p == NULL || q == NULL || p->n != 2 || q->n != 2 ||
        strcmp(own->file, library->file) == 0)
        return false;
    const char *a = p->first->text, *b = p->last->text, *c = q->first->text, *d = q->last->text;
    if (a == NULL || b == NULL || c == NULL || d == NULL)
        return false;
    return (strcmp(a, c) == 0 && strcmp(b, d) == 0) || (strcmp(a, d) == 0 && strcmp(b, c) == 0);
}

/* Appends a library's pairs that the job does not have. */
static void pairs_merge(struct yaml_tree_node *own, const struct yaml_tree_node *library)
{
    struct yaml_tree_node *next;
    if (own->kind != YAML_TREE_LIST || library->kind != YAML_TREE_LIST)
        return;
    for (struct yaml_tree_node *pair = library->first; pair != NULL; pair = next) {
        bool replaced = false;
        next = pair->next;
        /* A list that is too long is refused later; it need not be compared. */
        if (own->n <= JOB_KEYS_MAX_PAIRS)
            for (const struct yaml_tree_node *other = own->first; other != NULL && !replaced;
                 other = other->next)
                replaced = pair_is_replaced(other, pair);
        if (!replaced)
            yaml_tree_append(own, NULL, pair);
    }
}

/* The value of a key of a mapping, made empty where it is missing. */
static struct yaml_tree_node *key_ensure(struct yaml_tree *tree, struct yaml_tree_node *mapping,
                                         const char *key, enum yaml_tree_kind kind)
{
    struct yaml_tree_node *child = yaml_tree_find(mapping, key);
    if (child == NULL && mapping->kind == YAML_TREE_MAPPING) {
        child = yaml_tree_new(tree, kind, mapping);
        yaml_tree_append(mapping, key, child);
    }
    return child;
}

/* Slips a library under the job. */
static void library_merge(struct yaml_tree *tree, struct yaml_tree_node *root,
                          const struct yaml_tree_node *library, struct mistakes *mistakes)
{
    struct yaml_tree_node *next;
    char shown[YAML_TREE_SHOWN];
    if (library->kind != YAML_TREE_MAPPING) {
        mistakes_add(
            mistakes, library->file, library->line, library->column,
            "this is no mapping; a library with materials and contact.pairs is expected");
        return;
    }
    for (struct yaml_tree_node *child = library->first; child != NULL; child = next) {
        next = child->next;
        struct yaml_tree_node *pairs = yaml_tree_find(child, "pairs");
        if (strcmp(child->key, "materials") == 0) {
            mapping_merge(key_ensure(tree, root, "materials", YAML_TREE_MAPPING), child);
        } else if (strcmp(child->key, "contact") == 0 && pairs != NULL && child->n == 1) {
            struct yaml_tree_node *contact =
                key_ensure(tree, root, "contact", YAML_TREE_MAPPING);
            if (contact->kind == YAML_TREE_MAPPING)
                pairs_merge(key_ensure(tree, contact, "pairs", YAML_TREE_LIST), pairs);
        } else {
            mistakes_add(
                mistakes, child->file, child->key_line, child->key_column,
                "'%s' does not belong in a library; materials and contact: {pairs: ...} are "
                "expected",
                yaml_tree_shown(shown, child->key));
        }
    }
}

/* Reads one library; the mistake of a path that cannot be opened stands where the job names
 * it. */
static void library_read(struct yaml_tree *tree, struct yaml_tree_node *root,
                         const struct yaml_tree_node *include, struct mistakes *mistakes)
{
    *tree = (struct yaml_tree){0};
    if (include->kind != YAML_TREE_SCALAR || include->text[0] == '\0') {
        mistakes_add(
            mistakes, include->file, include->line, include->column,
            "include holds something else; the path of a file, or a list of them, is expected");
        return;
    }
    char *path = schema_path(include->text, include->file);
    FILE *file = fopen(path, "r");
    if (file == NULL)
        mistakes_add(
            mistakes, include->file, include->line, include->column,
            "include: '%.200s' cannot be read; a file relative to this one is expected", path);
    else if (fclose(file) == 0 && (yaml_tree_read(tree, path, mistakes) || tree->root != NULL))
        library_merge(tree, root, tree->root, mistakes);
    free(path);
}

/* Slips all libraries under the job, the last one first: a later one wins. */
static void libraries_read(struct yaml_tree *trees, struct yaml_tree_node *root,
                           struct mistakes *mistakes)
{
    const struct yaml_tree_node *include = yaml_tree_find(root, "include");
    if (include == NULL)
        return;
    if (include->kind != YAML_TREE_LIST) {
        library_read(&trees[0], root, include, mistakes);
        return;
    }
    if (include->n > MAX_LIBRARIES)
        mistakes_add(mistakes, include->file, include->line, include->column,
                     "include lists %d files; at most %d are expected", include->n,
                     MAX_LIBRARIES);
    for (int i = include->n - 1; i >= 0 && include->n <= MAX_LIBRARIES; i--)
        library_read(&trees[i], root, yaml_tree_child(include, i), mistakes);
}

/* ------------------------------------------------------------------------------- filling */

/* "runs/../hopper.yaml" -> "hopper".  The run's folder is called so: no name that leads out of
 * where it is, or that a terminal would obey. */
char *job_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *name = array_string(slash != NULL ? slash + 1 : path);
    char *point = strrchr(name, '.');
    if (point != NULL && point != name)
        *point = '\0';
    for (unsigned char *c = (unsigned char *)name; *c != '\0'; c++)
        if (*c < 0x20 || *c == 0x7f)
            *c = '_';
    if (name[0] == '\0' || strcmp(name, ".") == 0 || strcmp(name, "..") == 0) {
        free(name);
        name = array_string("job");
    }
    return name;
}

static int compare_texts(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* The names of all materials in the order that the schema gives them. */
static const char **material_names(const struct yaml_tree_node *root, int *n)
{
    const struct yaml_tree_node *materials = yaml_tree_find(root, "materials");
    const bool usable = materials != NULL && materials->kind == YAML_TREE_MAPPING;
    const char **names = array_allocate(usable ? (size_t)materials->n : 0, sizeof *names);
    *n = 0;
    for (const struct yaml_tree_node *m = usable ? materials->first : NULL; m != NULL;
         m = m->next)
        names[(*n)++] = m->key;
    qsort(names, (size_t)*n, sizeof *names, compare_texts);
    return names;
}

static int compare_pairs(const void *a, const void *b)
{
    const struct job_pair *p = a, *q = b;
    return p->a != q->a ? p->a - q->a : p->b - q->b;
}

/* Puts pairs into the order of their materials. */
static void pairs_sort(struct job *job)
{
    for (int k = 0; k < job->n_pairs; k++) {
        struct job_pair *pair = &job->pairs[k];
        const int a = pair->a, b = pair->b;
        pair->a = a < b ? a : b;
        pair->b = a < b ? b : a;
    }
    if (job->n_pairs > 0)
        qsort(job->pairs, (size_t)job->n_pairs, sizeof *job->pairs, compare_pairs);
}

static void material_clear(struct job_material *material)
{
    free(material->name);
    free(material->hardening_table);
}

/* Forgets the materials that nothing is made of, and their pairs. */
static void materials_prune(struct job *job, const bool *used)
{
    int *index = array_allocate((size_t)job->n_materials, sizeof *index);
    int n_materials = 0, n_pairs = 0;
    for (int m = 0; m < job->n_materials; m++) {
        index[m] = used[m] ? n_materials : -1;
        if (used[m])
            job->materials[n_materials++] = job->materials[m];
        else
            material_clear(&job->materials[m]);
    }
    for (int k = 0; k < job->n_pairs; k++) {
        struct job_pair pair = job->pairs[k];
        pair.a = index[pair.a];
        pair.b = index[pair.b];
        if (pair.a >= 0 && pair.b >= 0)
            job->pairs[n_pairs++] = pair;
    }
    job->n_materials = n_materials;
    job->n_pairs = n_pairs;
    for (int i = 0; i < job->n_spheres; i++)
        job->spheres[i].material = index[job->spheres[i].material];
    for (int i = 0; i < job->n_bodies; i++) {
        struct job_body *body = &job->bodies[i];
        body->material = index[body->material];
        for (int k = 0; k < body->solid.n_shells; k++)
            if (body->solid.shells[k].has_material)
                body->solid.shells[k].material = index[body->solid.shells[k].material];
    }
    for (int i = 0; i < job->n_insertions; i++) {
        struct job_insertion *insertion = &job->insertions[i];
        insertion->material = insertion->n_mix > 0 ? 0 : index[insertion->material];
        for (int k = 0; k < insertion->n_mix; k++)
            insertion->mix[k].material = index[insertion->mix[k].material];
    }
    free(index);
}

/* Radii, or radii between size classes. */
struct radii {
    int n, capacity;
    double *list;
};

static void radii_add(struct radii *radii, double radius)
{
    ARRAY_GROW(radii->list, radii->n + 1, radii->capacity);
    radii->list[radii->n++] = radius;
}

/* Puts them in order and each once. */
static void radii_sort(struct radii *radii)
{
    int n = 0;
    if (radii->n == 0)
        return;
    qsort(radii->list, (size_t)radii->n, sizeof *radii->list, array_compare_doubles);
    for (int k = 0; k < radii->n; k++)
        if (n == 0 || radii->list[k] > radii->list[n - 1])
            radii->list[n++] = radii->list[k];
    radii->n = n;
}

/* What the job says of radii: those that it names, the limits of distributions between two,
 * and what divides these: the radii of a cumulative curve; of others seven between their
 * limits, each the geometric mean of its neighbours. */
struct all_radii {
    struct radii named, limits, bounds;
};

static void divide(struct radii *bounds, double low, double high, int times)
{
    if (times == 0)
        return;
    const double middle = sqrt(low * high);
    radii_add(bounds, middle);
    divide(bounds, low, middle, times - 1);
    divide(bounds, middle, high, times - 1);
}

static void add_item(struct all_radii *all, double radius, const struct job_sizes *sizes)
{
    enum { HALVINGS = 3 };
    const bool table = sizes->given && sizes->kind == JOB_SIZES_TABLE;
    if (radius > 0.0)
        radii_add(&all->named, radius);
    for (int k = 0; sizes->kind == JOB_SIZES_LIST && k < sizes->n; k++)
        radii_add(&all->named, sizes->list[k].radius);
    if (!sizes->given || sizes->kind == JOB_SIZES_LIST)
        return;
    radii_add(&all->limits, table ? sizes->list[0].radius : sizes->min);
    radii_add(&all->limits, table ? sizes->list[sizes->n - 1].radius : sizes->max);
    for (int k = 1; table && k < sizes->n - 1; k++)
        radii_add(&all->bounds, sizes->list[k].radius);
    if (!table)
        divide(&all->bounds, sizes->min, sizes->max, HALVINGS);
}

/* Is there a radius or a limit between two? */
static bool has_between(const struct all_radii *all, double low, double high)
{
    bool any = false;
    for (int k = 0; k < all->named.n; k++)
        any = any || (all->named.list[k] > low && all->named.list[k] < high);
    for (int k = 0; k < all->limits.n; k++)
        any = any || (all->limits.list[k] > low && all->limits.list[k] < high);
    return any;
}

/* The bounds of size classes where a section names none; n of them, the list to be freed. */
static struct radii classes_of(const struct job *job)
{
    struct all_radii all = {{0}, {0}, {0}};
    for (int g = 0; g < job->n_spheres; g++)
        add_item(&all, job->spheres[g].radius, &job->spheres[g].sizes);
    for (int g = 0; g < job->n_insertions; g++)
        add_item(&all, job->insertions[g].radius, &job->insertions[g].sizes);
    radii_sort(&all.named);
    radii_sort(&all.limits);
    for (int k = 1; k < all.named.n; k++)
        radii_add(&all.bounds, 0.5 * (all.named.list[k - 1] + all.named.list[k]));
    for (int k = 0; k < all.limits.n; k++) /* where there are radii on either side of them */
        if (has_between(&all, -HUGE_VAL, all.limits.list[k]) &&
            has_between(&all, all.limits.list[k], HUGE_VAL))
            radii_add(&all.bounds, all.limits.list[k]);
    radii_sort(&all.bounds);
    free(all.named.list);
    free(all.limits.list);
    return all.bounds;
}

/* Gives size classes to the sections that ask for them and name none. */
static void classes_complete(struct job *job, const struct yaml_tree_node *root,
                             struct mistakes *mistakes)
{
    for (int s = 0; s < job->n_sections; s++) {
        struct job_section *section = &job->sections[s];
        if ((section->by & JOB_SPLIT_SIZE) == 0 || section->classes != NULL)
            continue;
        const struct radii bounds = classes_of(job);
        section->classes = bounds.list;
        section->n_classes = bounds.n;
        if (bounds.n < MAX_CLASSES)
            continue;
        char path[KEY_LENGTH];
        snprintf(path, sizeof path, "sections.%d.by", s);
        const struct yaml_tree_node *node = yaml_tree_nearest(root, path);
        mistakes_add(mistakes, node->file, node->line, node->column,
                     "%s: the radii of the job make %d size classes, more than %d; classes "
                     "are expected",
                     path, bounds.n + 1, MAX_CLASSES);
    }
}

/* Where item i of a list begins, if that is in the job file. */
static struct job_place place_of(const char *job_path, const struct yaml_tree_node *root,
                                 const char *list, int i)
{
    char path[KEY_LENGTH];
    snprintf(path, sizeof path, "%s.%d", list, i);
    const struct yaml_tree_node *node = yaml_tree_nearest(root, path);
    const bool ours = strcmp(node->file, job_path) == 0;
    return (struct job_place){ours ? node->line : 0, ours ? node->column : 0};
}

static void places_note(struct job *job, const struct yaml_tree_node *root)
{
    for (int i = 0; i < job->n_spheres; i++)
        job->spheres[i].place = place_of(job->path, root, "spheres", i);
    for (int i = 0; i < job->n_insertions; i++)
        job->insertions[i].place = place_of(job->path, root, "insert", i);
    for (int i = 0; i < job->n_bodies; i++) {
        struct job_body *body = &job->bodies[i];
        char list[KEY_LENGTH];
        body->place = place_of(job->path, root, "bodies", i);
        snprintf(list, sizeof list, "bodies.%d.sets", i);
        for (int k = 0; k < body->solid.n_sets; k++)
            body->solid.sets[k].place = place_of(job->path, root, list, k);
        snprintf(list, sizeof list, "bodies.%d.boundary", i);
        for (int k = 0; k < body->solid.n_boundary; k++)
            body->solid.boundary[k].place = place_of(job->path, root, list, k);
        snprintf(list, sizeof list, "bodies.%d.shells", i);
        for (int k = 0; k < body->solid.n_shells; k++)
            body->solid.shells[k].place = place_of(job->path, root, list, k);
        snprintf(list, sizeof list, "bodies.%d.thicknesses", i);
        for (int k = 0; k < body->solid.n_thicknesses; k++)
            body->solid.thicknesses[k].place = place_of(job->path, root, list, k);
        snprintf(list, sizeof list, "bodies.%d.masses", i);
        for (int k = 0; k < body->solid.n_masses; k++)
            body->solid.masses[k].place = place_of(job->path, root, list, k);
    }
    for (int i = 0; i < job->output.n_probes; i++)
        job->output.probes[i].place = place_of(job->path, root, "output.probes", i);
}

/* Fills the job from a complete tree and frees it again when there are mistakes. */
static bool job_fill(struct job *job, const char *path, const struct yaml_tree_node *root,
                     bool read_files, struct mistakes *mistakes)
{
    struct schema_reader reader = {.mistakes = mistakes};
    const char **names = material_names(root, &reader.n_names);
    reader.names = names;
    schema_read(&reader, job_keys, root, "", job);
    if (read_files)
        path_file_read_all(job, mistakes);
    job->path = array_string(path);
    job->name = job_name(path);
    bool *used = array_allocate((size_t)job->n_materials, sizeof *used);
    job_check(job, root, read_files, used, mistakes);
    bool fine = mistakes->n == 0;
    if (fine && read_files) {
        materials_prune(job, used);
        classes_complete(job, root, mistakes);
        fine = mistakes->n == 0;
    }
    if (fine) {
        pairs_sort(job);
        places_note(job, root);
    } else {
        job_clear(job);
    }
    free(used);
    free(names);
    return fine;
}

/* A job file with what the command line lays over it. */
struct text {
    struct yaml_tree tree; /* root NULL: it cannot be read */
    int n_values;
    struct yaml_tree *values;
};

static void text_read(struct text *text, const char *path, int n_overrides,
                      const struct job_override *overrides, struct mistakes *mistakes)
{
    text->n_values = n_overrides;
    text->values = array_allocate((size_t)n_overrides, sizeof *text->values);
    (void)yaml_tree_read(&text->tree, path, mistakes);
    for (int i = 0; text->tree.root != NULL && i < n_overrides; i++)
        override_apply(&text->values[i], text->tree.root, overrides[i].text, mistakes);
}

static void text_clear(struct text *text)
{
    for (int i = 0; i < text->n_values; i++)
        yaml_tree_clear(&text->values[i]);
    free(text->values);
    yaml_tree_clear(&text->tree);
}

bool job_read_variant(struct job *job, const char *path, int n_overrides,
                      const struct job_override *overrides, int variant,
                      struct mistakes *mistakes)
{
    struct yaml_tree libraries[MAX_LIBRARIES] = {{0}};
    struct sweep sweep = {0};
    struct text text;
    *job = (struct job){0};
    text_read(&text, path, n_overrides, overrides, mistakes);
    bool fine = text.tree.root != NULL;
    if (fine && variant > 0)
        fine = sweep_read(&sweep, &text.tree, mistakes);
    if (fine) {
        if (variant > 0)
            sweep_apply(&sweep, variant, &text.tree, mistakes);
        libraries_read(libraries, text.tree.root, mistakes);
        fine = job_fill(job, path, text.tree.root, true, mistakes);
    }
    for (int i = 0; i < MAX_LIBRARIES; i++)
        yaml_tree_clear(&libraries[i]);
    sweep_clear(&sweep);
    text_clear(&text);
    return fine;
}

bool job_read(struct job *job, const char *path, int n_overrides,
              const struct job_override *overrides, struct mistakes *mistakes)
{
    return job_read_variant(job, path, n_overrides, overrides, 0, mistakes);
}

bool job_read_sweep(struct sweep *sweep, const char *path, int n_overrides,
                    const struct job_override *overrides, struct mistakes *mistakes)
{
    struct text text;
    struct mistakes others; /* those of the text itself are found again with the job */
    mistakes_init(&others);
    *sweep = (struct sweep){0};
    text_read(&text, path, n_overrides, overrides, &others);
    const bool fine = text.tree.root == NULL || sweep_read(sweep, &text.tree, mistakes);
    for (int i = 0; i < n_overrides && fine; i++)
        sweep_refuse(sweep, overrides[i].text, mistakes);
    sweep_forget_places(sweep);
    text_clear(&text);
    mistakes_clear(&others);
    return mistakes->n == 0;
}

bool job_read_text(struct job *job, const char *path, const char *text,
                   struct mistakes *mistakes)
{
    struct yaml_tree tree;
    *job = (struct job){0};
    const bool fine = yaml_tree_parse(&tree, path, 1, text, strlen(text), mistakes) &&
                      job_fill(job, path, tree.root, false, mistakes);
    yaml_tree_clear(&tree);
    return fine;
}

void job_volume_clear(struct job_volume *volume)
{
    free(volume->nodes);
    free(volume->elements);
    free(volume->node_numbers);
    free(volume->element_numbers);
    free(volume->groups);
    free(volume->items);
    *volume = (struct job_volume){0};
}

void job_clear(struct job *job)
{
    for (int i = 0; i < job->n_bodies; i++)
        job_volume_clear(&job->bodies[i].solid.volume);
    schema_clear(job_keys, job);
    free(job->path);
    free(job->name);
    *job = (struct job){0};
}

int job_n_groups(const struct job *job)
{
    /* Jobs as used of before there were names of groups have no checksum either. */
    const bool unnamed = job->start.given && job->start.sum == 0 && job->start.n_groups == 0;
    return job->n_spheres + job->n_insertions + (unnamed ? 1 : job->start.n_groups);
}

const char *job_group_name(const struct job *job, int group)
{
    const int insertion = group - job->n_spheres, before = insertion - job->n_insertions;
    if (group < 0 || group >= job_n_groups(job))
        return NULL;
    if (insertion < 0)
        return job->spheres[group].name;
    if (before < 0)
        return job->insertions[insertion].name;
    return job->start.n_groups > 0 ? job->start.groups[before].name : "start";
}

char *job_write(const struct job *job)
{
    const char **names = array_allocate((size_t)job->n_materials, sizeof *names);
    for (int m = 0; m < job->n_materials; m++)
        names[m] = job->materials[m].name;
    char *text = NULL;
    size_t n = 0;
    FILE *out = open_memstream(&text, &n);
    CHECK(out != NULL, "out of memory for the text of the job");
    schema_write(out, job_keys, job, names);
    CHECK(fclose(out) == 0, "out of memory for the text of the job");
    free(names);
    return text;
}

static const char reference_head[] =
    "# The job file\n"
    "\n"
    "This page is written by `bin/tremie reference` from the table that also checks job\n"
    "files (`src/job/job_keys.c`); a test compares the two. `bin/tremie check JOB` lists\n"
    "every mistake of a file at once, as `file:line:column: what is wrong; what is\n"
    "expected`.\n"
    "\n"
    "A job is one YAML file in UTF-8 of at most 4 MiB, without anchors, aliases and tags.\n"
    "Keys are those below and no others. A number may carry a unit, like `2.5 mm`, `10 us`,\n"
    "`70 GPa`, `9.81 m/s2`, `30 deg` or `100 rpm`; without one it is in the SI unit given\n"
    "here. `2.5 mm` and `0.0025` are exactly the same number. `.` stands for a key inside a\n"
    "mapping, `[]` for the elements of a list, NAME for any name. What has no default and\n"
    "is not required is absent when left out.\n"
    "\n"
    "`include` names libraries, like `../config/materials.yaml`: files with `materials` and\n"
    "`contact: {pairs: ...}` alone. What the job itself says wins, key by key for a\n"
    "material, pair by pair for pairs. `--set KEY=VALUE` on the command line wins over\n"
    "both; it takes the same keys with numbers from 0 for the elements of lists, as in\n"
    "`--set spheres.0.radius=0.12`.\n"
    "\n"
    "A job with a `sweep` is a study: variants of the job, each with other values of some\n"
    "keys, each with a run of its own in a folder inside the study's that is named after\n"
    "them. A variant is the job with its values put where `--set` would put them.\n"
    "\n"
    "The folder of a run holds `job.yaml`: the job as used, libraries and defaults written\n"
    "out. On a resume `title`, `time.end`, `decomposition`, `checkpoint`, `output`, `watch`\n"
    "and `testing` may differ; everything else must be as it was.\n";

char *job_reference_page(void)
{
    char *text = NULL;
    size_t n = 0;
    FILE *out = open_memstream(&text, &n);
    CHECK(out != NULL, "out of memory for the reference page");
    fputs(reference_head, out);
    schema_reference(out, job_keys);
    CHECK(fclose(out) == 0, "out of memory for the reference page");
    return text;
}

/* ------------------------------------------------------------------------------- comparing */

/* What may change between a run and its resume. */
static const char *const may_differ[] = {"title",         "time.end", "output", "checkpoint",
                                         "decomposition", "testing",  "watch"};

/* How a value is shown in a message. */
static char *value_shown(const struct yaml_tree_node *node)
{
    char shown[YAML_TREE_SHOWN];
    if (node == NULL)
        return array_string("not given");
    if (node->kind == YAML_TREE_SCALAR)
        return array_string(yaml_tree_shown(shown, node->text));
    return array_format("%s of %d", node->kind == YAML_TREE_LIST ? "a list" : "a mapping",
                        node->n);
}

static char *difference_report(const char *path, const struct yaml_tree_node *was,
                               const struct yaml_tree_node *now)
{
    char *before = value_shown(was), *after = value_shown(now);
    char *text = array_format("%s: was %s, now %s", path, before, after);
    free(before);
    free(after);
    return text;
}

bool job_same_file(const char *a, const char *b)
{
    const char *p = strrchr(a, '/'), *q = strrchr(b, '/');
    return strcmp(p != NULL ? p + 1 : a, q != NULL ? q + 1 : b) == 0;
}

static bool scalars_equal(const char *key, const char *was, const char *now)
{
    if (key != NULL && (strcmp(key, "file") == 0 || strcmp(key, "from") == 0))
        return job_same_file(was, now);
    return strcmp(was, now) == 0;
}

/* The first difference between two nodes, NULL when there is none. */
static char *difference_find(const char *path, const struct yaml_tree_node *was,
                             const struct yaml_tree_node *now)
{
    for (size_t k = 0; k < sizeof may_differ / sizeof *may_differ; k++)
        if (strcmp(path, may_differ[k]) == 0)
            return NULL;
    if (was == NULL || now == NULL || was->kind != now->kind ||
        (was->kind == YAML_TREE_LIST && was->n != now->n))
        return difference_report(path, was, now);
    if (was->kind == YAML_TREE_SCALAR)
        return scalars_equal(was->key, was->text, now->text)
                   ? NULL
                   : difference_report(path, was, now);
    char *found = NULL;
    int i = 0;
    const struct yaml_tree_node *other = now->first;
    for (const struct yaml_tree_node *p = was->first; p != NULL && found == NULL;
         p = p->next, i++) {
        char *inner = p->key != NULL
                          ? array_format("%s%s%s", path, path[0] != '\0' ? "." : "", p->key)
                          : array_format("%s.%d", path, i);
        found = difference_find(inner, p, p->key != NULL ? yaml_tree_find(now, p->key) : other);
        other = other != NULL ? other->next : NULL;
        free(inner);
    }
    for (const struct yaml_tree_node *q = now->kind == YAML_TREE_MAPPING ? now->first : NULL;
         q != NULL && found == NULL; q = q->next) {
        if (yaml_tree_find(was, q->key) == NULL) {
            char *inner = array_format("%s%s%s", path, path[0] != '\0' ? "." : "", q->key);
            found = difference_find(inner, NULL, q);
            free(inner);
        }
    }
    return found;
}

char *job_difference(const char *was, const char *now)
{
    struct mistakes mistakes;
    struct yaml_tree before, after;
    mistakes_init(&mistakes);
    char *found;
    if (!yaml_tree_parse(&before, "was", 1, was, strlen(was), &mistakes))
        found = array_string("the job: was not readable, now is");
    else if (!yaml_tree_parse(&after, "now", 1, now, strlen(now), &mistakes))
        found = array_string("the job: was readable, now is not");
    else {
        found = difference_find("", before.root, after.root);
        yaml_tree_clear(&after);
    }
    yaml_tree_clear(&before);
    mistakes_clear(&mistakes);
    return found;
}
