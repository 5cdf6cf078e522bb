/* See file.h. */
#include "store/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"

static const char TEMPORARY_END[] = ".part";

static char *reason(int error)
{
    return array_string(strerror(error));
}

void file_survive_size_limit(void)
{
    signal(SIGXFSZ, SIG_IGN);
}

char *file_temporary(const char *path, const char *tag)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    return array_format("%.*s.%s%s%s%s", (int)(name - path), path, name,
                        tag[0] != '\0' ? "." : "", tag, TEMPORARY_END);
}

void file_remove_temporaries(const char *folder)
{
    DIR *entries = opendir(folder);
    if (entries == NULL)
        return;
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) {
        const size_t length = strlen(entry->d_name), end = sizeof TEMPORARY_END - 1;
        if (length > end && entry->d_name[0] == '.' &&
            strcmp(entry->d_name + length - end, TEMPORARY_END) == 0)
            (void)unlinkat(dirfd(entries), entry->d_name, 0);
    }
    closedir(entries);
}

/* Disk space for n bytes; 0 or the error. */
static int reserve(int descriptor, int64_t n)
{
    const int error = n > 0 ? posix_fallocate(descriptor, 0, n) : 0;
    /* A file system that cannot promise space will tell when it is written. */
    return error == EOPNOTSUPP || error == EINVAL || error == ENOSYS ? 0 : error;
}

char *file_reserve(const char *path, int64_t n)
{
    file_survive_size_limit();
    const int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return reason(errno);
    int error = reserve(descriptor, n);
    if (close(descriptor) != 0 && error == 0)
        error = errno;
    return error != 0 ? reason(error) : NULL;
}

/* Copies bytes begin .. end - 1; 0 or the error. */
static int copy_bytes(int to, int from, off_t begin, off_t end)
{
    char buffer[65536];
    while (begin < end) {
        const off_t left = end - begin;
        const size_t wanted = left < (off_t)sizeof buffer ? (size_t)left : sizeof buffer;
        const ssize_t n = pread(from, buffer, wanted, begin);
        if (n <= 0)
            return n < 0 ? errno : EIO;
        const ssize_t written = pwrite(to, buffer, (size_t)n, begin);
        if (written <= 0)
            return written < 0 ? errno : ENOSPC;
        begin += written;
    }
    return 0;
}

static int copy_data(int to, int from, off_t size)
{
    int error = 0;
    for (off_t end = 0; error == 0;) {
        const off_t begin = lseek(from, end, SEEK_DATA);
        if (begin < 0)
            return errno == ENXIO ? 0 : errno; /* ENXIO: nothing but a hole is left */
        end = lseek(from, begin, SEEK_HOLE);
        error = copy_bytes(to, from, begin, end < size ? end : size);
    }
    return error;
}

char *file_fill(const char *path, int source)
{
    file_survive_size_limit();
    struct stat state;
    const int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return reason(errno);
    int error = fstat(source, &state) != 0 ? errno : reserve(descriptor, state.st_size);
    if (error == 0)
        error = copy_data(descriptor, source, state.st_size);
    if (error == 0 && (ftruncate(descriptor, state.st_size) != 0 || fsync(descriptor) != 0))
        error = errno;
    if (close(descriptor) != 0 && error == 0)
        error = errno;
    return error != 0 ? reason(error) : NULL;
}

char *file_sync(const char *path)
{
    const int descriptor = open(path, O_RDWR | O_CLOEXEC);
    if (descriptor < 0)
        return reason(errno);
    int error = fsync(descriptor) != 0 ? errno : 0;
    if (close(descriptor) != 0 && error == 0)
        error = errno;
    return error != 0 ? reason(error) : NULL;
}

static char *sync_folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder =
        slash == NULL ? array_string(".") : array_format("%.*s/", (int)(slash - path), path);
    const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    free(folder);
    if (descriptor < 0)
        return reason(errno);
    /* Some file systems cannot sync a folder; they say EINVAL. */
    const int error = fsync(descriptor) != 0 && errno != EINVAL ? errno : 0;
    close(descriptor);
    return error != 0 ? reason(error) : NULL;
}

char *file_publish(const char *temporary, const char *path)
{
    if (rename(temporary, path) != 0)
        return reason(errno);
    return sync_folder_of(path);
}

static int write_all(int descriptor, const char *bytes, size_t n)
{
    while (n > 0) {
        const ssize_t written = write(descriptor, bytes, n);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return written < 0 ? errno : ENOSPC;
        bytes += written;
        n -= (size_t)written;
    }
    return fsync(descriptor) != 0 ? errno : 0;
}

char *file_prepare(const char *temporary, const void *bytes, size_t n)
{
    file_survive_size_limit();
    const int descriptor =
        open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return reason(errno);
    int error = write_all(descriptor, bytes, n);
    if (close(descriptor) != 0 && error == 0)
        error = errno;
    if (error != 0)
        unlink(temporary);
    return error != 0 ? reason(error) : NULL;
}

char *file_write(const char *path, const void *bytes, size_t n)
{
    return file_write_beside(path, "", bytes, n);
}

char *file_write_beside(const char *path, const char *tag, const void *bytes, size_t n)
{
    char *temporary = file_temporary(path, tag);
    char *why = file_prepare(temporary, bytes, n);
    if (why == NULL) {
        why = file_publish(temporary, path);
        if (why != NULL)
            unlink(temporary);
    }
    free(temporary);
    return why;
}

char *file_read(const char *path, size_t limit, char **text)
{
    *text = NULL;
    FILE *stream = fopen(path, "rbe");
    if (stream == NULL)
        return reason(errno);
    char *bytes = NULL;
    size_t n = 0, capacity = 0;
    while (n <= limit && !feof(stream) && !ferror(stream)) {
        ARRAY_GROW(bytes, n + 65536, capacity);
        n += fread(bytes + n, 1, 65535, stream);
    }
    const int error = ferror(stream) ? errno : 0;
    fclose(stream);
    if (error != 0 || n > limit) {
        free(bytes);
        return error != 0 ? reason(error) : array_format("it is larger than %zu bytes", limit);
    }
    bytes[n] = '\0';
    *text = bytes;
    return NULL;
}

char *file_make_folders(const char *path)
{
    char *part = array_string(path);
    int error = 0;
    for (char *p = part + 1; error == 0; p++) {
        const char end = *p;
        if (end != '/' && end != '\0')
            continue;
        *p = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST)
            error = errno;
        *p = end;
        if (end == '\0')
            break;
    }
    free(part);
    return error != 0 ? reason(error) : NULL;
}

/* -------------------------------------------------------------------------- files of a step */

char *file_step_path(const char *folder, int64_t step)
{
    return array_format("%s/step_%012lld.h5", folder, (long long)step);
}

/* The step in a name of file_step_path(), -1 when it is another name. */
static int64_t step_of(const char *name)
{
    enum { DIGITS_MIN = 12, DIGITS_MAX = 18 };
    static const char begin[] = "step_";
    if (strncmp(name, begin, sizeof begin - 1) != 0)
        return -1;
    const char *digits = name + sizeof begin - 1;
    const size_t n_digits = strspn(digits, "0123456789");
    if (n_digits < DIGITS_MIN || n_digits > DIGITS_MAX || strcmp(digits + n_digits, ".h5") != 0)
        return -1;
    return strtoll(digits, NULL, 10);
}

static int compare_steps(const void *a, const void *b)
{
    const int64_t *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

int file_steps(const char *folder, int64_t **steps)
{
    int n = 0, capacity = 0;
    *steps = NULL;
    DIR *entries = opendir(folder);
    if (entries == NULL)
        return errno == ENOENT ? 0 : -1;
    errno = 0;
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL; errno = 0) {
        const int64_t step = step_of(entry->d_name);
        if (step < 0)
            continue;
        ARRAY_GROW(*steps, n + 1, capacity);
        (*steps)[n++] = step;
    }
    const int error = errno;
    closedir(entries);
    errno = error;
    if (error != 0) {
        free(*steps);
        *steps = NULL;
        return -1;
    }
    if (n > 0)
        qsort(*steps, (size_t)n, sizeof **steps, compare_steps);
    return n;
}
