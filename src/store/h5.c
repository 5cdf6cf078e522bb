/*
 * See h5.h.
 *
 * HDF5 does not survive a disk that fails it: after a failed close the process crashes when it
 * ends.  So a new file is laid out in memory and copied to the disk by plain calls, whose
 * failures harm nobody.  The memory is an anonymous file, put in place of the one that HDF5
 * opened; only its pages in use exist, so it may be as long as it likes.  A drawback: it needs
 * Linux.
 */
#include "store/h5.h"

#include <dirent.h>
#include <errno.h>
#include <hdf5.h>
#include <mpi.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "store/file.h"

enum {
    TRANSFER_MAX = 1 << 29,
    CHUNK_ROWS = H5_PIECE_ROWS,
    PACKING_LEVEL = 4,
    NAME_MAX_LENGTH = 512
};
/* Deflate packs no more than so many bytes into one. */
enum { PACKED_MOST = 1032 };

/* --------------------------------------------------------------------------------- failures */

/* The innermost entry of HDF5's error stack says what really happened. */
static herr_t innermost(unsigned n, const H5E_error2_t *error, void *text)
{
    char **found = text;
    if (n == 0 && error->desc != NULL)
        *found = array_string(error->desc);
    return 0;
}

static char *hdf5_reason(void)
{
    char *text = NULL;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, innermost, &text);
    H5Eclear2(H5E_DEFAULT);
    if (text == NULL)
        return array_string("HDF5 gave no reason");
    static const char mark[] = "error message = '";
    const char *begin = strstr(text, mark);
    if (begin == NULL)
        return text;
    begin += sizeof mark - 1;
    char *system = array_format("%.*s", (int)strcspn(begin, "'"), begin);
    free(text);
    return system;
}

void h5_fail(struct h5 *h5, const char *format, ...)
{
    if (h5->why != NULL)
        return;
    char text[NAME_MAX_LENGTH];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    h5->why = array_string(text);
}

/* Notes a failure of HDF5 itself at `object`. */
static void fail_at(struct h5 *h5, const char *object)
{
    char *reason = hdf5_reason();
    h5_fail(h5, "%s%s%s", object, *object != '\0' ? ": " : "", reason);
    free(reason);
}

/* --------------------------------------------------------------------------- open and close */

static void prepare(struct h5 *h5)
{
    *h5 = (struct h5){.file = -1, .memory = -1};
    H5PLset_loading_state(0); /* no file makes us load and run a filter of its choice */
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

/* No locks, for nobody reads what is being written, and some file systems have none. */
static hid_t access_properties(void)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    return access;
}

/* Files that we write have one version of the format, whose metadata carry checksums, and
 * which does not mark files that are open. */
static void use_one_version(hid_t access)
{
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
}

/* From now on what HDF5 writes to its file goes to memory. */
static void keep_in_memory(struct h5 *h5)
{
    void *handle = NULL;
    h5->memory = memfd_create("tremie", MFD_CLOEXEC);
    if (H5Fget_vfd_handle(h5->file, H5P_DEFAULT, &handle) < 0 || handle == NULL)
        fail_at(h5, "");
    else if (h5->memory < 0 || dup2(h5->memory, *(const int *)handle) < 0)
        h5_fail(h5, "%s", strerror(errno));
}

void h5_create(struct h5 *h5, const char *path)
{
    prepare(h5);
    const hid_t access = access_properties(), creation = H5Pcreate(H5P_FILE_CREATE);
    use_one_version(access);
    H5Pset_obj_track_times(creation, false);
    h5->file = H5Fcreate(path, H5F_ACC_TRUNC, creation, access);
    if (h5->file < 0)
        fail_at(h5, ""); /* before another call, which would forget the reason */
    else
        keep_in_memory(h5);
    H5Pclose(creation);
    H5Pclose(access);
}

void h5_open(struct h5 *h5, const char *path)
{
    prepare(h5);
    const hid_t access = access_properties();
    h5->file = H5Fopen(path, H5F_ACC_RDONLY, access);
    if (h5->file < 0)
        fail_at(h5, "");
    H5Pclose(access);
}

void h5_open_shared(struct h5 *h5, const char *path, const struct comm *comm)
{
    prepare(h5);
    /* Open MPI's own way with files leaves locks and semaphores about, and hangs where disks
     * fail; it has a better one, chosen when the first file is opened. */
    setenv("OMPI_MCA_io", "^ompio", false);
    const hid_t access = access_properties();
    use_one_version(access);
    H5Pset_fapl_mpio(access, comm->mpi, MPI_INFO_NULL);
    h5->file = H5Fopen(path, H5F_ACC_RDWR, access);
    if (h5->file < 0)
        fail_at(h5, "");
    H5Pclose(access);
}

/* Sends what is written to a file to memory, through whatever descriptor it is open. */
static bool turn_away(const struct stat *file, int memory)
{
    bool well = true;
    DIR *open_files = opendir("/proc/self/fd");
    if (open_files == NULL)
        return false;
    for (struct dirent *entry; well && (entry = readdir(open_files)) != NULL;) {
        const int descriptor = atoi(entry->d_name);
        struct stat other;
        if (entry->d_name[0] != '.' && fstat(descriptor, &other) == 0 &&
            other.st_dev == file->st_dev && other.st_ino == file->st_ino)
            well = dup2(memory, descriptor) >= 0;
    }
    return closedir(open_files) == 0 && well;
}

void h5_let_go(struct h5 *h5, const char *path)
{
    struct stat file;
    h5->memory = memfd_create("tremie", MFD_CLOEXEC);
    if (stat(path, &file) != 0 || h5->memory < 0 || !turn_away(&file, h5->memory))
        h5_fail(h5, "%s", strerror(errno));
}

void h5_close(struct h5 *h5)
{
    if (h5->file >= 0 && H5Fclose(h5->file) < 0)
        fail_at(h5, "");
    h5->file = -1;
    if (h5->memory >= 0)
        close(h5->memory);
    h5->memory = -1;
}

void h5_save(struct h5 *h5, const char *path)
{
    const int memory = h5->memory;
    h5->memory = -1;
    h5_close(h5);
    char *why = h5->why == NULL ? file_fill(path, memory) : NULL;
    if (why != NULL)
        h5_fail(h5, "%s", why);
    free(why);
    if (memory >= 0)
        close(memory);
}

void h5_group(struct h5 *h5, const char *path)
{
    if (h5->why != NULL)
        return;
    const hid_t creation = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(creation, false);
    const hid_t group = H5Gcreate2(h5->file, path, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (group < 0 || H5Gclose(group) < 0)
        fail_at(h5, path);
    H5Pclose(creation);
}

/* The size of an object's file: so that nobody asks for memory that a damaged number names. */
static hsize_t file_size(struct h5 *h5, hid_t object, const char *path)
{
    hsize_t size = 0;
    const hid_t file = H5Iget_file_id(object); /* a link's is another one */
    if (file < 0 || H5Fget_filesize(file, &size) < 0)
        fail_at(h5, path);
    if (file >= 0)
        H5Fclose(file);
    return size;
}

/* ------------------------------------------------------------------------------- attributes */

static void put_attribute(struct h5 *h5, const char *object, const char *name, hid_t file_type,
                          hid_t memory_type, const void *value)
{
    if (h5->why != NULL)
        return;
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate_by_name(h5->file, object, name, file_type, space,
                                              H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0 || H5Awrite(attribute, memory_type, value) < 0)
        fail_at(h5, object);
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Sclose(space);
}

/* A string of fixed length; HDF5 has none of length 0, so "" takes one byte. */
static hid_t text_type(size_t length)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length > 0 ? length : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

void h5_put_text(struct h5 *h5, const char *object, const char *name, const char *text)
{
    const hid_t type = text_type(strlen(text));
    put_attribute(h5, object, name, type, type, text);
    H5Tclose(type);
}

void h5_put_int(struct h5 *h5, const char *object, const char *name, int64_t value)
{
    put_attribute(h5, object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void h5_put_double(struct h5 *h5, const char *object, const char *name, double value)
{
    put_attribute(h5, object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

/* Opens a scalar attribute whose type is of this class and whose size is at most `size_max`. */
static hid_t open_attribute(struct h5 *h5, const char *object, const char *name,
                            H5T_class_t class, size_t size_max, size_t *size)
{
    *size = 0;
    if (h5->why != NULL)
        return -1;
    const hid_t attribute = H5Aopen_by_name(h5->file, object, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) {
        fail_at(h5, object);
        return -1;
    }
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    *size = H5Tget_size(type);
    const bool fits = H5Tget_class(type) == class && H5Tis_variable_str(type) <= 0 &&
                      *size > 0 && *size <= size_max &&
                      *size <= file_size(h5, attribute, object) &&
                      H5Sget_simple_extent_npoints(space) == 1;
    H5Tclose(type);
    H5Sclose(space);
    if (fits)
        return attribute;
    h5_fail(h5, "%s: attribute %s is not what it should be", object, name);
    H5Aclose(attribute);
    return -1;
}

static void get_attribute(struct h5 *h5, const char *object, const char *name,
                          H5T_class_t class, hid_t memory_type, void *value)
{
    size_t size;
    const hid_t attribute = open_attribute(h5, object, name, class, 8, &size);
    if (attribute < 0)
        return;
    if (H5Aread(attribute, memory_type, value) < 0)
        fail_at(h5, object);
    H5Aclose(attribute);
}

int64_t h5_get_int(struct h5 *h5, const char *object, const char *name)
{
    int64_t value = 0;
    get_attribute(h5, object, name, H5T_INTEGER, H5T_NATIVE_INT64, &value);
    return value;
}

double h5_get_double(struct h5 *h5, const char *object, const char *name)
{
    double value = 0.0;
    get_attribute(h5, object, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, &value);
    return value;
}

char *h5_get_text(struct h5 *h5, const char *object, const char *name)
{
    enum { TEXT_MAX = 1 << 26 };
    size_t size;
    const hid_t attribute = open_attribute(h5, object, name, H5T_STRING, TEXT_MAX, &size);
    if (attribute < 0)
        return array_string("");
    char *text = array_allocate(size + 1, 1);
    const hid_t type = text_type(size);
    if (H5Aread(attribute, type, text) < 0)
        fail_at(h5, object);
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

/* Opens an attribute, which reads it. */
static herr_t look_at_attribute(hid_t object, const char *name, const H5A_info_t *info,
                                void *h5)
{
    (void)info;
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0)
        fail_at(h5, name);
    return attribute < 0 ? -1 : H5Aclose(attribute);
}

static herr_t look_at_object(hid_t file, const char *name, const H5O_info_t *info, void *h5)
{
    (void)info;
    const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
    if (object < 0) {
        fail_at(h5, name);
        return -1;
    }
    const herr_t status =
        H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, look_at_attribute, h5);
    if (status < 0)
        fail_at(h5, name);
    return H5Oclose(object) < 0 ? -1 : status;
}

void h5_look_around(struct h5 *h5)
{
    if (h5->why == NULL &&
        H5Ovisit(h5->file, H5_INDEX_NAME, H5_ITER_NATIVE, look_at_object, h5) < 0)
        fail_at(h5, "");
}

bool h5_has(struct h5 *h5, const char *path)
{
    return h5->why == NULL && H5Lexists(h5->file, path, H5P_DEFAULT) > 0;
}

/* -------------------------------------------------------------------------------- data sets */

static hid_t file_type(enum field_type type)
{
    switch (type) {
    case FIELD_INT64:
        return H5T_STD_I64LE;
    case FIELD_INT32:
        return H5T_STD_I32LE;
    case FIELD_FLOAT:
        return H5T_IEEE_F32LE;
    case FIELD_DOUBLE:
    default:
        return H5T_IEEE_F64LE;
    }
}

static hid_t memory_type(enum field_type type)
{
    switch (type) {
    case FIELD_INT64:
        return H5T_NATIVE_INT64;
    case FIELD_INT32:
        return H5T_NATIVE_INT32;
    case FIELD_FLOAT:
        return H5T_NATIVE_FLOAT;
    case FIELD_DOUBLE:
    default:
        return H5T_NATIVE_DOUBLE;
    }
}

/* Space is there from the start, and nobody's clock is written. */
static hid_t contiguous_properties(void)
{
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_layout(creation, H5D_CONTIGUOUS);
    H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(creation, false);
    return creation;
}

void h5_put_document(struct h5 *h5, const char *path, const char *text)
{
    if (h5->why != NULL)
        return;
    const hid_t type = text_type(strlen(text)), space = H5Screate(H5S_SCALAR);
    const hid_t creation = contiguous_properties();
    const hid_t set =
        H5Dcreate2(h5->file, path, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0)
        fail_at(h5, path);
    if (set >= 0)
        H5Dclose(set);
    H5Pclose(creation);
    H5Sclose(space);
    H5Tclose(type);
}

char *h5_get_document(struct h5 *h5, const char *path)
{
    enum { DOCUMENT_MAX = 1 << 28 };
    const hid_t set = h5->why == NULL ? H5Dopen2(h5->file, path, H5P_DEFAULT) : -1;
    if (set < 0) {
        fail_at(h5, path);
        return array_string("");
    }
    const hid_t stored = H5Dget_type(set), space = H5Dget_space(set);
    const size_t size = H5Tget_size(stored);
    const bool fits = H5Tget_class(stored) == H5T_STRING && H5Tis_variable_str(stored) <= 0 &&
                      size > 0 && size <= DOCUMENT_MAX &&
                      H5Sget_simple_extent_npoints(space) == 1 &&
                      size <= file_size(h5, set, path);
    char *text = array_allocate(fits ? size + 1 : 1, 1);
    const hid_t type = text_type(size);
    if (!fits)
        h5_fail(h5, "%s is not a text", path);
    else if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0)
        fail_at(h5, path);
    H5Tclose(type);
    H5Tclose(stored);
    H5Sclose(space);
    H5Dclose(set);
    return text;
}

static void declare(struct h5 *h5, const char *path, const struct field *field, int64_t n,
                    hid_t creation)
{
    const hsize_t shape[2] = {(hsize_t)n, (hsize_t)field->width};
    const hid_t space = H5Screate_simple(field->width > 1 ? 2 : 1, shape, NULL);
    const hid_t set = H5Dcreate2(h5->file, path, file_type(field->type), space, H5P_DEFAULT,
                                 creation, H5P_DEFAULT);
    if (set < 0 || H5Dclose(set) < 0)
        fail_at(h5, path);
    H5Sclose(space);
    h5_put_text(h5, path, "unit", field->unit);
    h5_put_text(h5, path, "description", field->help);
}

void h5_declare_rows(struct h5 *h5, const char *path, const struct field *field, int64_t n)
{
    if (h5->why != NULL)
        return;
    const hid_t creation = contiguous_properties();
    declare(h5, path, field, n, creation);
    H5Pclose(creation);
}

void h5_declare_packed_rows(struct h5 *h5, const char *path, const struct field *field,
                            int64_t n)
{
    const hsize_t chunk[2] = {(hsize_t)(n < CHUNK_ROWS ? n : CHUNK_ROWS),
                              (hsize_t)field->width};
    if (h5->why != NULL)
        return;
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    if (n > 0) {
        H5Pset_chunk(creation, field->width > 1 ? 2 : 1, chunk);
        H5Pset_shuffle(creation);
        H5Pset_deflate(creation, PACKING_LEVEL);
    }
    declare(h5, path, field, n, creation);
    H5Pclose(creation);
}

unsigned char *h5_pack(const struct field *field, int64_t n_total, int64_t n, const void *rows,
                       size_t *size)
{
    const size_t width = (size_t)field->width, each = field_component_size(field->type);
    const size_t n_rows = (size_t)(n_total < CHUNK_ROWS ? n_total : CHUNK_ROWS);
    const size_t n_values = n_rows * width, n_given = (size_t)n * width;
    const unsigned char *bytes = rows;
    unsigned char *shuffled = array_allocate(n_values, each);
    for (size_t i = 0; i < n_given; i++) /* all first bytes, then all second ones */
        for (size_t k = 0; k < each; k++)
            shuffled[k * n_values + i] = bytes[i * each + k];
    uLongf length = compressBound((uLong)(n_values * each));
    unsigned char *packed = array_allocate(length, 1);
    const int status =
        compress2(packed, &length, shuffled, (uLong)(n_values * each), PACKING_LEVEL);
    CHECK(status == Z_OK, "zlib fails with status %d", status);
    free(shuffled);
    *size = length;
    return packed;
}

void h5_put_packed(struct h5 *h5, const char *path, int64_t begin, size_t size,
                   const void *packed)
{
    const hsize_t place[2] = {(hsize_t)begin, 0};
    const hid_t set = h5->why == NULL ? H5Dopen2(h5->file, path, H5P_DEFAULT) : -1;
    if (h5->why != NULL)
        return;
    if (set < 0 || H5Dwrite_chunk(set, H5P_DEFAULT, 0, place, size, packed) < 0)
        fail_at(h5, path);
    if (set >= 0)
        H5Dclose(set);
}

void h5_link(struct h5 *h5, const char *path, const char *file, const char *object)
{
    if (h5->why == NULL &&
        H5Lcreate_external(file, object, h5->file, path, H5P_DEFAULT, H5P_DEFAULT) < 0)
        fail_at(h5, path);
}

/* The number of values in a piece of a packed data set; 0: it is not packed. */
static hsize_t piece_of(hid_t set)
{
    hsize_t shape[H5S_MAX_RANK], n = 0;
    const hid_t creation = H5Dget_create_plist(set);
    if (H5Pget_layout(creation) == H5D_CHUNKED) {
        const int rank = H5Pget_chunk(creation, H5S_MAX_RANK, shape);
        n = 1;
        for (int k = 0; k < rank; k++)
            n *= shape[k]; /* HDF5 has no piece of 4 GiB or more */
    }
    H5Pclose(creation);
    return n;
}

/* The shape of a data set as rows x width; false when it has neither one nor two dimensions. */
static bool shape_of(hid_t set, int64_t *n, int64_t *width)
{
    hsize_t shape[2] = {0, 1};
    const hid_t space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool fits =
        (rank == 1 || rank == 2) && H5Sget_simple_extent_dims(space, shape, NULL) == rank;
    H5Sclose(space);
    *n = (int64_t)shape[0];
    *width = (int64_t)shape[1];
    return fits && *n >= 0;
}

/* Opens a data set after comparing it with the field; *n is its number of rows. */
static hid_t open_rows(struct h5 *h5, const char *path, const struct field *field, int64_t *n)
{
    *n = 0;
    if (h5->why != NULL)
        return -1;
    const hid_t set = H5Dopen2(h5->file, path, H5P_DEFAULT);
    if (set < 0) {
        fail_at(h5, path);
        return -1;
    }
    int64_t width;
    const hid_t type = H5Dget_type(set);
    const bool fits = shape_of(set, n, &width) && width == field->width &&
                      H5Tequal(type, file_type(field->type)) > 0;
    H5Tclose(type);
    if (fits)
        return set;
    h5_fail(h5, "%s has another type or shape than it should have", path);
    *n = 0;
    H5Dclose(set);
    return -1;
}

int64_t h5_count_rows(struct h5 *h5, const char *path, const struct field *field)
{
    int64_t n;
    const hid_t set = open_rows(h5, path, field, &n);
    if (set < 0)
        return 0;
    const hsize_t piece = piece_of(set);
    const hsize_t most = file_size(h5, set, path) * (piece > 0 ? PACKED_MOST : 1);
    if (h5->why == NULL && ((hsize_t)n > most / field_size(field) ||
                            piece > most / field_component_size(field->type)))
        h5_fail(h5, "%s has more rows than the file can hold", path);
    H5Dclose(set);
    return h5->why == NULL ? n : 0;
}

int64_t h5_find_rows(struct h5 *h5, const char *path, struct field *field)
{
    static const enum field_type types[] = {FIELD_DOUBLE, FIELD_INT64, FIELD_INT32,
                                            FIELD_FLOAT};
    enum { N_TYPES = sizeof types / sizeof *types };
    const hid_t set = h5->why == NULL ? H5Dopen2(h5->file, path, H5P_DEFAULT) : -1;
    if (set < 0) {
        fail_at(h5, path);
        return 0;
    }
    int64_t n, width;
    const hid_t type = H5Dget_type(set);
    int k = 0;
    while (k < N_TYPES && H5Tequal(type, file_type(types[k])) <= 0)
        k++;
    if (!shape_of(set, &n, &width) || k == N_TYPES || width < 1 || width > INT16_MAX)
        h5_fail(h5, "%s has a type or shape of its own", path);
    field->type = types[k < N_TYPES ? k : 0];
    field->width = (int)width;
    H5Tclose(type);
    H5Dclose(set);
    return h5_count_rows(h5, path, field);
}

/* Moves rows begin .. begin + n - 1 between file and memory, in pieces that MPI's int counts
 * can hold.  Each rank moves its own contiguous run without the others, so that one whose
 * disk fails leaves nobody waiting. */
static void transfer(struct h5 *h5, hid_t set, const struct field *field, int64_t begin,
                     int64_t n, void *rows, bool write)
{
    const size_t size = field_size(field);
    const int64_t rows_max = (int64_t)(TRANSFER_MAX / size);
    const hid_t space = H5Dget_space(set), type = memory_type(field->type);
    for (int64_t done = 0; done < n && h5->why == NULL;) {
        const int64_t part = n - done < rows_max ? n - done : rows_max;
        const hsize_t start[2] = {(hsize_t)(begin + done), 0};
        const hsize_t count[2] = {(hsize_t)part, (hsize_t)field->width};
        const hid_t memory = H5Screate_simple(field->width > 1 ? 2 : 1, count, NULL);
        char *at = (char *)rows + (size_t)done * size;
        herr_t status = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
        if (status >= 0)
            status = write ? H5Dwrite(set, type, memory, space, H5P_DEFAULT, at)
                           : H5Dread(set, type, memory, space, H5P_DEFAULT, at);
        if (status < 0)
            fail_at(h5, "");
        H5Sclose(memory);
        done += part;
    }
    H5Sclose(space);
}

static void move_rows(struct h5 *h5, const char *path, const struct field *field, int64_t begin,
                      int64_t n, void *rows, bool write)
{
    int64_t n_there;
    const hid_t set = open_rows(h5, path, field, &n_there);
    if (set < 0)
        return;
    if (begin < 0 || n < 0 || begin > n_there || n > n_there - begin)
        h5_fail(h5, "%s has %lld rows, fewer than it should have", path, (long long)n_there);
    else
        transfer(h5, set, field, begin, n, rows, write);
    H5Dclose(set);
}

void h5_write_rows(struct h5 *h5, const char *path, const struct field *field, int64_t begin,
                   int64_t n, const void *rows)
{
    union { /* transfer() only reads when it writes to the file */
        const void *given;
        void *passed;
    } memory = {.given = rows};
    move_rows(h5, path, field, begin, n, memory.passed, true);
}

void h5_read_rows(struct h5 *h5, const char *path, const struct field *field, int64_t begin,
                  int64_t n, void *rows)
{
    move_rows(h5, path, field, begin, n, rows, false);
}

void h5_put_column(struct h5 *h5, const char *path, const struct field *field, int64_t n,
                   const double *values)
{
    if (h5->why != NULL)
        return;
    const hsize_t chunk = (hsize_t)(n < CHUNK_ROWS ? n : CHUNK_ROWS);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    if (n > 0) {
        H5Pset_chunk(creation, 1, &chunk);
        H5Pset_fletcher32(creation);
    }
    declare(h5, path, field, n, creation);
    H5Pclose(creation);
    h5_write_rows(h5, path, field, 0, n, values);
}
