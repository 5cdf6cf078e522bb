/*
 * The reader of checkpoints, fed with a good one to which something was done: an input is a
 * list of edits of 12 bytes each.  Edits act on what the file means (through HDF5: numbers,
 * lengths, types, whole objects) or on its bytes.  Our checksums are turned off, as the linker
 * puts a constant in their place, also when the good one is made, so that edits get past them.
 */
#include <hdf5.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "fuzz.h"
#include "job/job.h"
#include "model/sphere.h"
#include "run/check.h"
#include "run/simulation.h"
#include "run/step.h"
#include "store/checkpoint.h"
#include "store/crc32.h"
#include "store/file.h"
#include "store/run_folder.h"

enum { EDIT = 12, EDITS_MOST = 16, NAMES_MOST = 128, STEPS = 60 };

struct edit {
    uint8_t op, object;
    uint16_t index;
    uint8_t value[8];
};

static struct {
    struct comm comm;
    struct job job;
    size_t n_bytes;
    char *bytes; /* of the good checkpoint */
    int n_names;
    char *names[NAMES_MOST]; /* of its objects */
} fuzz;

static const char JOB[] =
    "title: t\n"
    "time: {end: 0.1, step: 1.0e-4}\n"
    "damping: 0.1\n"
    "materials:\n"
    "  a: {density: 2400, young: 5.0e7, poisson: 0.2}\n"
    "  b: {density: 1100, young: 2.0e7, poisson: 0.45}\n"
    "contact:\n"
    "  pairs:\n"
    "    - {between: [a, a], friction: 0.5, restitution: 0.5, rolling_friction: 0.1, "
    "twisting_friction: 0.1}\n"
    "    - {between: [a, b], friction: 0.5, restitution: 0.5}\n"
    "    - {between: [b, b], friction: 0.5, restitution: 0.5}\n"
    "spheres:\n"
    "  - {name: s, material: a, radius: 0.05, velocity: [0, 0, -1], packing: {kind: lattice, "
    "count: 18, spacing: 0.1001, corner: [-0.15, -0.15, 0.0001], size: [0.31, 0.31]}}\n"
    "insert:\n"
    "  - {name: i, material: b, radius: 0.02, region: {kind: box, min: [-0.2, -0.2, 0.5], max: "
    "[0.2, 0.2, 0.7]}, rate: {number: 2000}, until: {count: 50}, every: 10}\n"
    "remove:\n"
    "  - {name: r, region: {kind: box, min: [0.1, 0.1, 0], max: [0.2, 0.2, 0.1]}}\n"
    "bodies:\n"
    "  - {name: floor, material: b, geometry: {kind: plane, point: [0, 0, 0], normal: [0, 0, 1], "
    "extent: 2}}\n"
    "  - {name: block, material: b, free: {density: 2000}, geometry: {kind: box, min: [0.3, 0.3, "
    "0], max: [0.4, 0.4, 0.1]}}\n"
    "sections:\n"
    "  - {name: x, point: [0, 0, 0.1], normal: [0, 0, 1]}\n"
    "domain: {min: [-1, -1, -1], max: [1, 1, 1], leavers: remove}\n"
    "watch: {overlap: 0.5}\n";

uint32_t __wrap_crc32_of(const struct crc32 *crc, const void *bytes, size_t n);
uint32_t __wrap_crc32_of(const struct crc32 *crc, const void *bytes, size_t n)
{
    (void)crc;
    (void)bytes;
    (void)n;
    return 1;
}

static herr_t add_name(hid_t file, const char *name, const H5O_info_t *info, void *unused)
{
    (void)file;
    (void)info;
    (void)unused;
    if (strcmp(name, ".") != 0 && fuzz.n_names < NAMES_MOST)
        fuzz.names[fuzz.n_names++] = array_string(name);
    return 0;
}

/* Runs the job to a checkpoint and keeps that. */
static void make_good_one(void)
{
    char place[] = "good.XXXXXX";
    struct simulation sim;
    struct run_folder folder = {.path = mkdtemp(place)};
    CHECK(folder.path != NULL, "no folder");
    CHECK(simulation_create(&sim, &fuzz.comm, &fuzz.job, ISA_AUTO) == REPORT_FINISHED,
          "no scene");
    while (sim.step < STEPS)
        step(&sim);
    char *text = job_write(&fuzz.job), *path = run_folder_checkpoint_path(&folder, sim.step);
    char *checkpoints = array_format("%s/checkpoints", place),
         *series = array_format("%s/series", place);
    free(file_make_folders(checkpoints));
    free(file_make_folders(series));
    CHECK(simulation_save(&sim, &folder, text) == REPORT_FINISHED, "not saved");
    FILE *in = fopen(path, "rb");
    CHECK(in != NULL, "no checkpoint");
    fuzz.bytes = array_allocate(1 << 20, 1);
    fuzz.n_bytes = fread(fuzz.bytes, 1, 1 << 20, in);
    fclose(in);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add_name, NULL, H5O_INFO_BASIC);
    H5Fclose(file);
    simulation_destroy(&sim);
    char *command = array_format("rm -r %s", place);
    CHECK(system(command) == 0, "not cleared up");
    free(command);
    free(text);
    free(path);
    free(checkpoints);
    free(series);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    struct mistakes mistakes;
    MPI_Init(argc, argv);
    fuzz.comm = comm_world();
    report_init(false);
    mistakes_init(&mistakes);
    CHECK(job_read_text(&fuzz.job, "job.yaml", JOB, &mistakes) &&
              check_complete(&fuzz.job, 1, &mistakes),
          "the job: %s", mistakes.n > 0 ? mistakes.list[0].text : "");
    make_good_one();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return 0;
}

/* ------------------------------------------------------------------------------------ edits */

/* A value in a data set. */
static void set_value(hid_t set, const struct edit *edit)
{
    const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
    const hssize_t n = H5Sget_simple_extent_npoints(space);
    const size_t size = H5Tget_size(type);
    if (n > 0 && n < 100000 && size <= 65536) {
        char *values = calloc((size_t)n, size);
        const size_t at = (size_t)edit->index * 8 % ((size_t)n * size);
        const size_t left = (size_t)n * size - at;
        if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) {
            memcpy(values + at, edit->value, left < 8 ? left : 8);
            H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
        }
        free(values);
    }
    H5Tclose(type);
    H5Sclose(space);
}

/* The data set anew, with another length or type, and the values and attributes that it had. */
static void remake(hid_t file, const char *name, const struct edit *edit, bool retype)
{
    const hid_t types[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_I32LE, H5T_IEEE_F32LE,
                           H5T_C_S1};
    int64_t length;
    memcpy(&length, edit->value, sizeof length);
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    const hid_t type = retype ? H5Tcopy(types[edit->index % 5]) : H5Dget_type(set);
    hsize_t shape[2] = {0, 0};
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank >= 1 && rank <= 2) {
        H5Sget_simple_extent_dims(space, shape, NULL);
        if (!retype)
            shape[edit->index % (unsigned)rank] =
                (hsize_t)(length < 0 ? -(length + 1) : length);
        const hid_t wanted = H5Screate_simple(rank, shape, NULL);
        hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_alloc_time(creation, H5D_ALLOC_TIME_LATE);
        H5Ldelete(file, name, H5P_DEFAULT);
        const hid_t made =
            H5Dcreate2(file, name, type, wanted, H5P_DEFAULT, creation, H5P_DEFAULT);
        const hid_t one = H5Screate(H5S_SCALAR);
        const hid_t sum = made < 0 ? -1
                                   : H5Acreate2(made, "checksum", H5T_STD_I64LE, one,
                                                H5P_DEFAULT, H5P_DEFAULT);
        const int64_t right = 1;
        if (sum >= 0) {
            H5Awrite(sum, H5T_NATIVE_INT64, &right);
            H5Aclose(sum);
        }
        H5Sclose(one);
        if (made >= 0)
            H5Dclose(made);
        H5Pclose(creation);
        H5Sclose(wanted);
    }
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(set);
}

/* An attribute of an object: the number or the first bytes of its text. */
static void set_attribute(hid_t file, const char *name, const struct edit *edit)
{
    H5O_info_t info;
    if (H5Oget_info_by_name2(file, name, &info, H5O_INFO_NUM_ATTRS, H5P_DEFAULT) < 0 ||
        info.num_attrs == 0)
        return;
    const hid_t attribute =
        H5Aopen_by_idx(file, name, H5_INDEX_NAME, H5_ITER_INC, edit->index % info.num_attrs,
                       H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    const size_t size = H5Tget_size(type);
    char *value = calloc(size + 8, 1);
    if (size <= 65536 && H5Aread(attribute, type, value) >= 0) {
        memcpy(value, edit->value, 8);
        H5Awrite(attribute, type, value);
    }
    free(value);
    H5Tclose(type);
    H5Aclose(attribute);
}

static void apply(hid_t file, const struct edit *edit)
{
    const char *name = fuzz.names[edit->object % fuzz.n_names];
    H5O_info_t info;
    if (H5Oget_info_by_name2(file, name, &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0)
        return;
    const int op = edit->op % 8;
    if (op == 7) {
        H5Ldelete(file, name, H5P_DEFAULT);
    } else if (op == 6 || info.type != H5O_TYPE_DATASET) {
        set_attribute(file, name, edit);
    } else if (op >= 4) {
        remake(file, name, edit, op == 4);
    } else {
        const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
        set_value(set, edit);
        H5Dclose(set);
    }
}

/* The good checkpoint with these edits, as a file. */
static const char *edited(const uint8_t *data, size_t size)
{
    char *bytes = array_allocate(fuzz.n_bytes, 1);
    memcpy(bytes, fuzz.bytes, fuzz.n_bytes);
    size_t n = fuzz.n_bytes;
    const bool raw = size % 2 == 1;
    for (size_t k = 0; raw && k + EDIT <= size; k += EDIT) {
        uint32_t at;
        memcpy(&at, data + k, sizeof at);
        if (data[k + 4] == 0)
            n = at % (n + 1);
        else if (n > 0)
            bytes[at % n] ^= (char)data[k + 4];
    }
    const char *path = fuzz_file(bytes, n);
    free(bytes);
    const hid_t file = raw ? -1 : H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    for (size_t k = 0; file >= 0 && k + EDIT <= size && k / EDIT < EDITS_MOST; k += EDIT) {
        struct edit edit;
        memcpy(&edit, data + k, sizeof edit);
        apply(file, &edit);
    }
    if (file >= 0)
        H5Fclose(file);
    return path;
}

static void leave(void *into, int n, struct contact_record *records)
{
    (void)into;
    (void)n;
    (void)records;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct spheres spheres;
    spheres_init(&spheres);
    struct checkpoint checkpoint = {
        .spheres = &spheres, .full = true, .ledger = true, .removals = true};
    const char *path = edited(data, size);
    if (checkpoint_read(&fuzz.comm, path, &checkpoint) == REPORT_FINISHED) {
        (void)checkpoint_read_contacts(&fuzz.comm, path, &checkpoint, leave, NULL);
        checkpoint_clear(&checkpoint);
    }
    spheres_clear(&spheres);
    return 0;
}
