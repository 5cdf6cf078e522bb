/* See study_file.h. */
#include "store/study_file.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "job/yaml_tree.h"
#include "store/file.h"

static char *path_of(const char *folder)
{
    return array_format("%s/study.yaml", folder);
}

bool study_file_is_there(const char *folder)
{
    char *path = path_of(folder);
    const bool there = access(path, F_OK) == 0;
    free(path);
    return there;
}

/* ------------------------------------------------------------------------------- writing */

/* Plain where YAML takes it so, else in quotes. */
static void text_write(FILE *out, const char *text)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "0123456789._+-";
    if (text[0] != '\0' && strspn(text, plain) == strlen(text)) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text != '\0'; text++)
        if ((unsigned char)*text < ' ')
            fprintf(out, "\\x%02x", (unsigned)*text);
        else
            fprintf(out, "%s%c", *text == '"' || *text == '\\' ? "\\" : "", *text);
    fputc('"', out);
}

static char *list_write(const char *job, const struct sweep *sweep)
{
    char *text = NULL;
    size_t n = 0;
    FILE *out = open_memstream(&text, &n);
    CHECK(out != NULL, "out of memory for the list of a study");
    fputs("# A study: each variant has its run in the folder that it names.\njob: ", out);
    text_write(out, job);
    fputs("\nkeys:\n", out);
    for (int k = 0; k < sweep->n_keys; k++) {
        fprintf(out, "  %s: ", sweep->names[k]);
        text_write(out, sweep->keys[k]);
        fputc('\n', out);
    }
    fputs("variants:\n", out);
    for (int v = 1; v <= sweep->n_variants; v++) {
        fputs("  - {folder: ", out);
        text_write(out, sweep->folders[v - 1]);
        for (int k = 0; k < sweep->n_keys; k++) {
            fprintf(out, "%s%s: ", k == 0 ? ", values: {" : ", ", sweep->names[k]);
            text_write(out, sweep_value(sweep, v, k));
        }
        fputs("}}\n", out);
    }
    CHECK(fclose(out) == 0, "out of memory for the list of a study");
    return text;
}

/* ------------------------------------------------------------------------------- reading */

/* The text of a key of a mapping; NULL where there is none. */
static const char *text_at(const struct yaml_tree_node *mapping, const char *key)
{
    const struct yaml_tree_node *node = yaml_tree_find(mapping, key);
    return node != NULL ? node->text : NULL;
}

static bool variant_read(struct sweep *sweep, int v, const struct yaml_tree_node *node)
{
    const struct yaml_tree_node *values = yaml_tree_find(node, "values");
    const char *folder = text_at(node, "folder");
    bool fine = folder != NULL && strchr(folder, '/') == NULL;
    sweep->folders[v] = array_string(fine ? folder : "");
    for (int k = 0; k < sweep->n_keys; k++) {
        const char *value = text_at(values, sweep->names[k]);
        sweep->values[v * sweep->n_keys + k] = array_string(value != NULL ? value : "");
        fine = fine && value != NULL;
    }
    return fine;
}

static bool list_read(struct sweep *sweep, const struct yaml_tree_node *root)
{
    const struct yaml_tree_node *keys = yaml_tree_find(root, "keys");
    const struct yaml_tree_node *variants = yaml_tree_find(root, "variants");
    *sweep = (struct sweep){0};
    if (keys == NULL || keys->kind != YAML_TREE_MAPPING || variants == NULL ||
        variants->kind != YAML_TREE_LIST || variants->n > SWEEP_MOST)
        return false;
    const size_t n_keys = (size_t)keys->n, n_variants = (size_t)variants->n;
    bool fine = true;
    int v = 0;
    sweep->keys = array_allocate(n_keys, sizeof *sweep->keys);
    sweep->names = array_allocate(n_keys, sizeof *sweep->names);
    sweep->folders = array_allocate(n_variants, sizeof *sweep->folders);
    sweep->values = array_allocate(n_variants * n_keys, sizeof *sweep->values);
    for (const struct yaml_tree_node *key = keys->first; key != NULL; key = key->next) {
        sweep->names[sweep->n_keys] = array_string(key->key);
        sweep->keys[sweep->n_keys++] = array_string(key->text != NULL ? key->text : "");
        fine = fine && key->text != NULL;
    }
    for (const struct yaml_tree_node *node = variants->first; node != NULL; node = node->next)
        fine = variant_read(sweep, v++, node) && fine;
    sweep->n_variants = v;
    return fine;
}

/* Reads the list and the job's name; false, with nothing to clear, when it is damaged. */
static bool file_take(const char *folder, struct sweep *sweep, char **job)
{
    struct mistakes mistakes;
    struct yaml_tree tree;
    char *path = path_of(folder), *text = NULL;
    mistakes_init(&mistakes);
    free(file_read(path, INT_MAX, &text));
    bool fine = text != NULL && yaml_tree_parse(&tree, path, 1, text, strlen(text), &mistakes);
    fine = fine && list_read(sweep, tree.root);
    const char *name = fine ? text_at(tree.root, "job") : NULL;
    *job = array_string(name != NULL ? name : "");
    if (text != NULL)
        yaml_tree_clear(&tree);
    if (!fine)
        sweep_clear(sweep);
    mistakes_clear(&mistakes);
    free(text);
    free(path);
    return fine;
}

int study_file_read(const char *folder, struct sweep *sweep)
{
    char *job;
    *sweep = (struct sweep){0};
    const bool fine = file_take(folder, sweep, &job);
    free(job);
    if (fine)
        return REPORT_FINISHED;
    report_error("cannot make sense of %s/study.yaml; running a variant with --fresh writes it "
                 "anew",
                 folder);
    return REPORT_STORAGE;
}

/* ------------------------------------------------------------------------------- both */

static bool same_keys(const struct sweep *a, const struct sweep *b)
{
    bool same = a->n_keys == b->n_keys;
    for (int k = 0; k < a->n_keys && same; k++)
        same = strcmp(a->keys[k], b->keys[k]) == 0 && strcmp(a->names[k], b->names[k]) == 0;
    return same;
}

/* May a study of this job be here?  Says why not. */
static int judge(const char *folder, const char *job, const struct sweep *sweep, bool fresh)
{
    char *run = array_format("%s/job.yaml", folder), *theirs;
    const bool is_run = access(run, F_OK) == 0;
    struct sweep before = {0};
    int status = REPORT_FINISHED;
    free(run);
    if (is_run) {
        report_error("%s holds a run and no study; name another folder with --out", folder);
        return REPORT_BAD_INPUT;
    }
    if (fresh || !study_file_is_there(folder))
        return REPORT_FINISHED;
    if (!file_take(folder, &before, &theirs) || strcmp(theirs, job) != 0 ||
        !same_keys(&before, sweep)) {
        report_error("%s belongs to another study, of job '%s' or other keys; name another "
                     "folder with --out, or start over with --fresh",
                     folder, theirs);
        status = REPORT_BAD_INPUT;
    }
    sweep_clear(&before);
    free(theirs);
    return status;
}

int study_file_write(const char *folder, const char *job, const struct sweep *sweep, bool fresh)
{
    char host[256] = "", *was = NULL;
    int status = judge(folder, job, sweep, fresh);
    if (status != REPORT_FINISHED)
        return status;
    char *path = path_of(folder), *text = list_write(job, sweep);
    gethostname(host, sizeof host - 1);
    char *tag = array_format("%s-%ld", host, (long)getpid());
    char *why = file_make_folders(folder);
    free(file_read(path, INT_MAX, &was));
    if (why == NULL && (was == NULL || strcmp(was, text) != 0))
        why = file_write_beside(path, tag, text, strlen(text));
    if (why != NULL) {
        report_error("cannot write %s: %s; name another folder with --out", path, why);
        status = REPORT_STORAGE;
    }
    free(why);
    free(was);
    free(tag);
    free(text);
    free(path);
    return status;
}
