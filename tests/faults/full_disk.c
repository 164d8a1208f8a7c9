// LD_PRELOAD: a disk that is full from the N-th write to a file on (AA_FULL_AT=N), or a count of the writes, as text in the
// file AA_COUNT_WRITES at the end.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static atomic_long writes;

static int is_full(int file) {
    struct stat about;
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) return 0;
    const char* at = getenv("AA_FULL_AT");
    const long number = ++writes;
    if (!at || number < atol(at)) return 0;
    errno = ENOSPC;
    return 1;
}

ssize_t write(int file, const void* bytes, size_t count) {
    static ssize_t (*next)(int, const void*, size_t);
    if (!next) next = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
    return is_full(file) ? -1 : next(file, bytes, count);
}
ssize_t writev(int file, const struct iovec* pieces, int count) {
    static ssize_t (*next)(int, const struct iovec*, int);
    if (!next) next = (ssize_t(*)(int, const struct iovec*, int))dlsym(RTLD_NEXT, "writev");
    return is_full(file) ? -1 : next(file, pieces, count);
}

__attribute__((destructor)) static void tell(void) {
    const char* file = getenv("AA_COUNT_WRITES");
    if (!file) return;
    const int out = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out >= 0) dprintf(out, "%ld", (long)writes);
}
