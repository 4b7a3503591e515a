// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Fails chosen calls of the C library; preloaded by run_faults.py. Environment:
//
// ADASPLATS_FAULT=KIND:N fails call N of a kind, counted from 1; KIND:N+ also all later ones.
//
// ADASPLATS_FAULT_FOLDER: only files below this folder count.
//
// ADASPLATS_FAULT_FIRED: a file that is created when a call fails.
//
// ADASPLATS_FAULT_COUNTS: a file that gets the number of calls of each kind when main() returns.
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum Kind { kMemory, kOpen, kRead, kMap, kWrite, kSync, kRename, kMkdir, kList, kKinds };
static const char* const kNames[kKinds] = {"memory", "open",   "read",  "map", "write",
                                           "sync",   "rename", "mkdir", "list"};
static const int kErrors[kKinds] = {ENOMEM, EMFILE, EIO, ENOMEM, ENOSPC, EIO, EIO, ENOSPC, EIO};

enum { kDescriptors = 4096 };
static atomic_long calls[kKinds];
static atomic_bool counted[kDescriptors];  // descriptors of files in the folder
static atomic_bool running;                // within main()
static long fail_at;                       // 0: never
static int fail_kind, fail_later;
static const char* folder;
static const char* fired_file;

static int fails(enum Kind kind) {
  if (!atomic_load(&running)) return 0;
  const long call = atomic_fetch_add(&calls[kind], 1) + 1;
  if (fail_at == 0 || (int)kind != fail_kind) return 0;
  if (call != fail_at && !(fail_later && call > fail_at)) return 0;
  if (fired_file != NULL)
    syscall(SYS_close, syscall(SYS_openat, AT_FDCWD, fired_file, O_WRONLY | O_CREAT, 0644));
  errno = kErrors[kind];
  return 1;
}

static int in_folder(int at, const char* path) {
  if (folder == NULL) return 0;
  if (path[0] != '/') return at == AT_FDCWD || (at >= 0 && at < kDescriptors && counted[at]);
  return strncmp(path, folder, strlen(folder)) == 0;
}

static int is_counted(int fd) { return fd >= 0 && fd < kDescriptors && atomic_load(&counted[fd]); }

static int note(int fd, int is_in_folder) {
  if (fd >= 0 && fd < kDescriptors) atomic_store(&counted[fd], is_in_folder);
  return fd;
}

static int has_mode(int flags) {
  return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
}

#define NEXT(result, name, ...)       \
  static result (*next)(__VA_ARGS__); \
  if (next == NULL) *(void**)&next = dlsym(RTLD_NEXT, name)

// ---- memory

void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* memory, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);

void* malloc(size_t bytes) { return fails(kMemory) ? NULL : __libc_malloc(bytes); }
void* calloc(size_t count, size_t bytes) {
  return fails(kMemory) ? NULL : __libc_calloc(count, bytes);
}
void* realloc(void* memory, size_t bytes) {
  return fails(kMemory) ? NULL : __libc_realloc(memory, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  return fails(kMemory) ? NULL : __libc_memalign(alignment, bytes);
}
void* memalign(size_t alignment, size_t bytes) { return aligned_alloc(alignment, bytes); }
int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  void* const found = aligned_alloc(alignment, bytes);
  if (found == NULL) return ENOMEM;
  *memory = found;
  return 0;
}

// ---- files

#define OPEN_AT(name)                                                      \
  int name(int at, const char* path, int flags, ...) {                     \
    NEXT(int, #name, int, const char*, int, ...);                          \
    va_list list;                                                          \
    va_start(list, flags);                                                 \
    const mode_t mode = has_mode(flags) ? va_arg(list, mode_t) : 0;        \
    va_end(list);                                                          \
    if (!in_folder(at, path)) return note(next(at, path, flags, mode), 0); \
    return fails(kOpen) ? -1 : note(next(at, path, flags, mode), 1);       \
  }
OPEN_AT(openat)
OPEN_AT(openat64)

#define OPEN(name)                                                  \
  int name(const char* path, int flags, ...) {                      \
    va_list list;                                                   \
    va_start(list, flags);                                          \
    const mode_t mode = has_mode(flags) ? va_arg(list, mode_t) : 0; \
    va_end(list);                                                   \
    return openat(AT_FDCWD, path, flags, mode);                     \
  }
OPEN(open)
OPEN(open64)

#define FOPEN(name)                                            \
  FILE* name(const char* path, const char* mode) {             \
    NEXT(FILE*, #name, const char*, const char*);              \
    if (!in_folder(AT_FDCWD, path)) return next(path, mode);   \
    FILE* const file = fails(kOpen) ? NULL : next(path, mode); \
    if (file != NULL) note(fileno(file), 1);                   \
    return file;                                               \
  }
FOPEN(fopen)
FOPEN(fopen64)

int close(int fd) {
  NEXT(int, "close", int);
  return next(note(fd, 0));
}
int fclose(FILE* file) {
  NEXT(int, "fclose", FILE*);
  note(fileno(file), 0);
  return next(file);
}

ssize_t read(int fd, void* to, size_t bytes) {
  NEXT(ssize_t, "read", int, void*, size_t);
  return is_counted(fd) && fails(kRead) ? -1 : next(fd, to, bytes);
}
ssize_t write(int fd, const void* from, size_t bytes) {
  NEXT(ssize_t, "write", int, const void*, size_t);
  return is_counted(fd) && fails(kWrite) ? -1 : next(fd, from, bytes);
}
ssize_t writev(int fd, const struct iovec* parts, int count) {
  NEXT(ssize_t, "writev", int, const struct iovec*, int);
  return is_counted(fd) && fails(kWrite) ? -1 : next(fd, parts, count);
}

#define PREAD(name)                                                       \
  ssize_t name(int fd, void* to, size_t bytes, off_t at) {                \
    NEXT(ssize_t, #name, int, void*, size_t, off_t);                      \
    return is_counted(fd) && fails(kRead) ? -1 : next(fd, to, bytes, at); \
  }
PREAD(pread)
PREAD(pread64)
#define PWRITE(name)                                                         \
  ssize_t name(int fd, const void* from, size_t bytes, off_t at) {           \
    NEXT(ssize_t, #name, int, const void*, size_t, off_t);                   \
    return is_counted(fd) && fails(kWrite) ? -1 : next(fd, from, bytes, at); \
  }
PWRITE(pwrite)
PWRITE(pwrite64)
#define TRUNCATE(name)                                             \
  int name(int fd, off_t bytes) {                                  \
    NEXT(int, #name, int, off_t);                                  \
    return is_counted(fd) && fails(kWrite) ? -1 : next(fd, bytes); \
  }
TRUNCATE(ftruncate)
TRUNCATE(ftruncate64)

ssize_t sendfile(int to, int from, off_t* at, size_t bytes) {
  NEXT(ssize_t, "sendfile", int, int, off_t*, size_t);
  return is_counted(to) && fails(kWrite) ? -1 : next(to, from, at, bytes);
}

#define MAP(name)                                                                      \
  void* name(void* place, size_t bytes, int protection, int flags, int fd, off_t at) { \
    NEXT(void*, #name, void*, size_t, int, int, int, off_t);                           \
    if (is_counted(fd) && fails(kMap)) return MAP_FAILED;                              \
    return next(place, bytes, protection, flags, fd, at);                              \
  }
MAP(mmap)
MAP(mmap64)

#define SYNC(name)                                         \
  int name(int fd) {                                       \
    NEXT(int, #name, int);                                 \
    return is_counted(fd) && fails(kSync) ? -1 : next(fd); \
  }
SYNC(fsync)
SYNC(fdatasync)

int rename(const char* from, const char* to) {
  NEXT(int, "rename", const char*, const char*);
  return in_folder(AT_FDCWD, from) && fails(kRename) ? -1 : next(from, to);
}
int renameat2(int at, const char* from, int to_at, const char* to, unsigned flags) {
  NEXT(int, "renameat2", int, const char*, int, const char*, unsigned);
  return in_folder(at, from) && fails(kRename) ? -1 : next(at, from, to_at, to, flags);
}
int mkdir(const char* path, mode_t mode) {
  NEXT(int, "mkdir", const char*, mode_t);
  return in_folder(AT_FDCWD, path) && fails(kMkdir) ? -1 : next(path, mode);
}

DIR* opendir(const char* path) {
  NEXT(DIR*, "opendir", const char*);
  DIR* const listed = next(path);
  if (listed != NULL) note(dirfd(listed), in_folder(AT_FDCWD, path));
  return listed;
}
int closedir(DIR* listed) {
  NEXT(int, "closedir", DIR*);
  note(dirfd(listed), 0);
  return next(listed);
}
#define READDIR(name, type)                                                 \
  struct type* name(DIR* listed) {                                          \
    NEXT(struct type*, #name, DIR*);                                        \
    return is_counted(dirfd(listed)) && fails(kList) ? NULL : next(listed); \
  }
READDIR(readdir, dirent)
READDIR(readdir64, dirent64)

// ---- the run

static void read_settings(void) {
  folder = getenv("ADASPLATS_FAULT_FOLDER");
  fired_file = getenv("ADASPLATS_FAULT_FIRED");
  const char* const fault = getenv("ADASPLATS_FAULT");
  const char* const colon = fault == NULL ? NULL : strchr(fault, ':');
  if (colon == NULL) return;
  fail_kind = -1;
  for (int kind = 0; kind < kKinds; ++kind)
    if (strncmp(fault, kNames[kind], (size_t)(colon - fault)) == 0) fail_kind = kind;
  if (fail_kind < 0) abort();
  char* end = NULL;
  fail_at = strtol(colon + 1, &end, 10);
  fail_later = *end == '+';
}

static void write_counts(void) {
  const char* const path = getenv("ADASPLATS_FAULT_COUNTS");
  if (path == NULL) return;
  const int fd = (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  char line[64];
  for (int kind = 0; kind < kKinds; ++kind) {
    const int size = snprintf(line, sizeof line, "%s %ld\n", kNames[kind], calls[kind]);
    if (syscall(SYS_write, fd, line, size) != size) break;
  }
  syscall(SYS_close, fd);
}

typedef int (*Main)(int, char**, char**);
static Main real_main;
static int counted_main(int argc, char** argv, char** environment) {
  read_settings();
  atomic_store(&running, 1);
  const int result = real_main(argc, argv, environment);
  atomic_store(&running, 0);
  write_counts();
  return result;
}

int __libc_start_main(Main main, int argc, char** argv, void (*init)(void), void (*fini)(void),
                      void (*end)(void), void* stack) {
  NEXT(int, "__libc_start_main", Main, int, char**, void (*)(void), void (*)(void), void (*)(void),
       void*);
  real_main = main;
  return next(counted_main, argc, argv, init, fini, end, stack);
}
