// LD_PRELOAD: a world that goes wrong at a chosen moment.
//   AA_FULL_AT=N      from the N-th write to a file on the disk is full
//   AA_SHRINKS=FILE   with AA_SHRINK_AT=N: at the N-th time that FILE is opened or read, half of it is gone
//   AA_CLOCK=S        the clock shows S seconds more
//   AA_COUNT=FILE     at the end FILE holds, as text, how many writes there were, and how often AA_SHRINKS was touched
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#define NEXT(name) __typeof__(&name) next = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

static atomic_long writes, touches;

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
    NEXT(write);
    return is_full(file) ? -1 : next(file, bytes, count);
}
ssize_t writev(int file, const struct iovec* pieces, int count) {
    NEXT(writev);
    return is_full(file) ? -1 : next(file, pieces, count);
}

static void touch(int file) {
    const char* shrinks = getenv("AA_SHRINKS");
    struct stat touched, meant;
    if (!shrinks || file < 0 || fstat(file, &touched) != 0 || stat(shrinks, &meant) != 0) return;
    if (touched.st_ino != meant.st_ino || touched.st_dev != meant.st_dev) return;
    const char* at = getenv("AA_SHRINK_AT");
    if (++touches == (at ? atol(at) : 0) && truncate(shrinks, meant.st_size / 2) != 0) abort();
}
static FILE* touched(FILE* file) {
    const int before = errno;
    if (file) touch(fileno(file));
    errno = before;
    return file;
}
FILE* fopen(const char* path, const char* mode) {
    NEXT(fopen);
    return touched(next(path, mode));
}
FILE* fopen64(const char* path, const char* mode) {
    NEXT(fopen64);
    return touched(next(path, mode));
}
ssize_t read(int file, void* bytes, size_t count) {
    NEXT(read);
    touch(file);
    return next(file, bytes, count);
}

static time_t ahead(void) {
    const char* seconds = getenv("AA_CLOCK");
    return seconds ? atol(seconds) : 0;
}
int clock_gettime(clockid_t clock, struct timespec* now) {
    NEXT(clock_gettime);
    const int failed = next(clock, now);
    if (!failed && clock == CLOCK_REALTIME) now->tv_sec += ahead();
    return failed;
}
time_t time(time_t* now) {
    NEXT(time);
    const time_t t = next(NULL) + ahead();
    if (now) *now = t;
    return t;
}

__attribute__((destructor)) static void tell(void) {
    const char* file = getenv("AA_COUNT");
    if (!file) return;
    const int out = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out >= 0) dprintf(out, "%ld %ld", (long)writes, (long)touches);
}
