/* See content.h. */
#include "content.h"

#include <hdf5.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"

enum { TEXT_MAX = 1 << 28 };
static const double VALUES_MAX = 0x1p33; /* of a data set: more is not ours */

static enum content_kind kind_of(hid_t type)
{
    const H5T_class_t class = H5Tget_class(type);
    if (class == H5T_INTEGER && H5Tget_size(type) <= sizeof(int64_t))
        return CONTENT_INT;
    if (class == H5T_FLOAT && H5Tget_size(type) <= sizeof(double))
        return CONTENT_DOUBLE;
    if (class == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Tget_size(type) <= TEXT_MAX)
        return CONTENT_TEXT;
    return CONTENT_OTHER;
}

/* Adds an item of this type and shape; takes the path. */
static void add_item(struct content *content, char *path, hid_t type, hid_t space)
{
    hsize_t sizes[H5S_MAX_RANK] = {1};
    const int n_sizes = H5Sget_simple_extent_dims(space, sizes, NULL);
    struct content_item item = {path, kind_of(type), n_sizes > 0 ? (int64_t)sizes[0] : 1, 1};
    double n_values = (double)item.n_rows;
    for (int k = 1; k < n_sizes; k++) {
        n_values *= (double)sizes[k];
        item.width = n_values < VALUES_MAX ? item.width * (int64_t)sizes[k] : 1;
    }
    if (!(n_values < VALUES_MAX))
        item.kind = CONTENT_OTHER;
    if (item.kind == CONTENT_TEXT && item.n_rows == 1)
        item.width = (int64_t)H5Tget_size(type);
    else if (item.kind == CONTENT_TEXT)
        item.kind = CONTENT_OTHER; /* lists of texts: we write none */
    ARRAY_GROW(content->items, content->n + 1, content->capacity);
    content->items[content->n++] = item;
}

static void add_set(struct content *content, const char *path)
{
    const hid_t set = H5Dopen2(content->file, path, H5P_DEFAULT);
    if (set < 0)
        return;
    const hid_t type = H5Dget_type(set), space = H5Dget_space(set);
    add_item(content, array_string(path), type, space);
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(set);
}

/* What the walk over a group's attributes needs to know. */
struct walk {
    struct content *content;
    const char *path;
};

static herr_t visit_attribute(hid_t object, const char *name, const H5A_info_t *info,
                              void *data)
{
    (void)info;
    const struct walk *walk = data;
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0)
        return -1;
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    add_item(walk->content, array_format("%s@%s", walk->path, name), type, space);
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    return 0;
}

static herr_t visit_object(hid_t file, const char *name, const H5O_info_t *info, void *data)
{
    struct content *content = data;
    char *path = strcmp(name, ".") == 0 ? array_string("/") : array_format("/%s", name);
    herr_t status = 0;
    if (info->type == H5O_TYPE_DATASET) {
        add_set(content, path);
    } else if (info->type == H5O_TYPE_GROUP) {
        struct walk walk = {content, path};
        status = H5Aiterate_by_name(file, name, H5_INDEX_NAME, H5_ITER_INC, NULL,
                                    visit_attribute, &walk, H5P_DEFAULT);
    }
    free(path);
    return status;
}

static int compare_paths(const void *a, const void *b)
{
    const struct content_item *p = a, *q = b;
    return strcmp(p->path, q->path);
}

char *content_open(struct content *content, const char *path)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    /* Our files are whole once they have their name, so readers need no lock, which some file
     * systems do not have. */
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    *content = (struct content){.file = H5Fopen(path, H5F_ACC_RDONLY, access)};
    H5Pclose(access);
    if (content->file < 0)
        return array_format("%s is not a whole HDF5 file", path);
    if (H5Ovisit(content->file, H5_INDEX_NAME, H5_ITER_INC, visit_object, content) < 0) {
        content_clear(content);
        return array_format("the groups of %s are damaged", path);
    }
    if (content->n > 0)
        qsort(content->items, (size_t)content->n, sizeof *content->items, compare_paths);
    return NULL;
}

void content_clear(struct content *content)
{
    for (int i = 0; i < content->n; i++)
        free(content->items[i].path);
    free(content->items);
    H5Fclose(content->file);
    *content = (struct content){0};
}

const struct content_item *content_find(const struct content *content, const char *path)
{
    for (int i = 0; i < content->n; i++)
        if (strcmp(content->items[i].path, path) == 0)
            return &content->items[i];
    return NULL;
}

static bool read_attribute(const struct content *content, const char *object, const char *name,
                           hid_t type, void *values)
{
    const hid_t attribute =
        H5Aopen_by_name(content->file, object, name, H5P_DEFAULT, H5P_DEFAULT);
    const bool read = attribute >= 0 && H5Aread(attribute, type, values) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    return read;
}

/* Reads an item as values of this type into memory of n bytes; NULL when that fails. */
static void *read_item(const struct content *content, const struct content_item *item,
                       hid_t type, size_t n)
{
    void *values = array_allocate(n, 1);
    const char *at = strchr(item->path, '@');
    bool read;
    if (at != NULL) {
        char *object = array_format("%.*s", (int)(at - item->path), item->path);
        read = read_attribute(content, object, at + 1, type, values);
        free(object);
    } else {
        const hid_t set = H5Dopen2(content->file, item->path, H5P_DEFAULT);
        read = set >= 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
        if (set >= 0)
            H5Dclose(set);
    }
    if (read)
        return values;
    free(values);
    return NULL;
}

int64_t *content_ints(const struct content *content, const struct content_item *item)
{
    if (item->kind != CONTENT_INT)
        return NULL;
    return read_item(content, item, H5T_NATIVE_INT64,
                     (size_t)(item->n_rows * item->width) * sizeof(int64_t));
}

double *content_doubles(const struct content *content, const struct content_item *item)
{
    if (item->kind != CONTENT_DOUBLE)
        return NULL;
    return read_item(content, item, H5T_NATIVE_DOUBLE,
                     (size_t)(item->n_rows * item->width) * sizeof(double));
}

/* The type of an item as the file has it; negative when it cannot be opened. */
static hid_t stored_type(const struct content *content, const char *object,
                         const char *attribute)
{
    hid_t type = -1;
    if (attribute != NULL) {
        const hid_t found =
            H5Aopen_by_name(content->file, object, attribute, H5P_DEFAULT, H5P_DEFAULT);
        if (found >= 0) {
            type = H5Aget_type(found);
            H5Aclose(found);
        }
    } else {
        const hid_t set = H5Dopen2(content->file, object, H5P_DEFAULT);
        if (set >= 0) {
            type = H5Dget_type(set);
            H5Dclose(set);
        }
    }
    return type;
}

char *content_text(const struct content *content, const struct content_item *item)
{
    if (item->kind != CONTENT_TEXT)
        return NULL;
    const char *at = strchr(item->path, '@');
    char *object = at != NULL ? array_format("%.*s", (int)(at - item->path), item->path)
                              : array_string(item->path);
    const hid_t type = stored_type(content, object, at != NULL ? at + 1 : NULL);
    char *text = type >= 0 ? read_item(content, item, type, (size_t)item->width + 1) : NULL;
    if (type >= 0)
        H5Tclose(type);
    free(object);
    return text;
}

char *content_note(const struct content *content, const char *object, const char *name)
{
    const hid_t type = stored_type(content, object, name);
    const bool fits = type >= 0 && kind_of(type) == CONTENT_TEXT;
    char *text = array_allocate(fits ? H5Tget_size(type) + 1 : 1, 1);
    if (fits && !read_attribute(content, object, name, type, text))
        text[0] = '\0';
    if (type >= 0)
        H5Tclose(type);
    return text;
}
