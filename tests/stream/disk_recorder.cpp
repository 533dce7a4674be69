// Preloaded into a program (LD_PRELOAD), records what it does to the folder $HOUGHSTREAM_DISK_FOLDER, in order: names
// that it makes, moves and removes, and what it syncs. Each is a line of $HOUGHSTREAM_DISK_RECORD/operations, fields
// between tabs; what a file holds when it is synced is copied to $HOUGHSTREAM_DISK_RECORD/NUMBER. With
// $HOUGHSTREAM_DISK_NO_EXCHANGE the folder lies on a file system that cannot exchange two names.

#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <mutex>
#include <string>

namespace {

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::string environment(const char* name) {
  const char* value = getenv(name);
  return value == nullptr ? "" : value;
}

std::string link_of(int file) {
  char target[4096];
  const ssize_t size = readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), target, sizeof target);
  return size < 0 ? "" : std::string(target, static_cast<std::size_t>(size));
}

/// Absolute, as the program names it from a folder.
std::string path_of(int folder, const char* name) {
  if (name[0] == '/') return name;
  char here[4096];
  const std::string base = folder == AT_FDCWD ? (getcwd(here, sizeof here) == nullptr ? "" : here) : link_of(folder);
  return base + "/" + name;
}

bool is_recorded(const std::string& path) {
  const std::string folder = environment("HOUGHSTREAM_DISK_FOLDER");
  return !folder.empty() && (path == folder || path.rfind(folder + "/", 0) == 0);
}

std::mutex& record_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Appends a line, and returns its number.
int record(const std::string& line) {
  static int number = 0;
  const std::lock_guard<std::mutex> lock(record_mutex());
  const std::string file = environment("HOUGHSTREAM_DISK_RECORD") + "/operations";
  const int out =
      real<int(const char*, int, ...)>("open")(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  const std::string text = line + "\n";
  if (out < 0 || write(out, text.data(), text.size()) != static_cast<ssize_t>(text.size())) abort();
  close(out);
  return number++;
}

void record_file(const char* what, const std::string& path) {
  struct stat is {};
  if (!is_recorded(path) || lstat(path.c_str(), &is) != 0) return;
  record(std::string(what) + "\t" + path + "\t" + std::to_string(is.st_ino));
}

void record_names(const char* what, const std::string& from, const std::string& to) {
  if (is_recorded(from) || is_recorded(to)) record(std::string(what) + "\t" + from + "\t" + to);
}

bool exists(const std::string& path) {
  struct stat is {};
  return lstat(path.c_str(), &is) == 0;
}

/// Notes a file that did not exist before.
int opened(int file, bool is_new, const std::string& path) {
  const int error = errno;
  if (file >= 0 && is_new) record_file("create", path);
  errno = error;
  return file;
}

template <typename Open>
int open_and_record(Open open_file, const std::string& path, int flags) {
  const bool is_new = (flags & O_CREAT) != 0 && !exists(path);
  return opened(open_file(), is_new, path);
}

FILE* fopen_and_record(const char* function, const char* name, const char* mode) {
  const std::string path = path_of(AT_FDCWD, name);
  const bool is_new = !exists(path);
  FILE* file = real<FILE*(const char*, const char*)>(function)(name, mode);
  if (file != nullptr) opened(0, is_new, path);
  return file;
}

void record_sync(int file) {
  struct stat is {};
  const std::string path = link_of(file);
  if (!is_recorded(path) || fstat(file, &is) != 0) return;
  if (S_ISDIR(is.st_mode)) {
    record("sync_folder\t" + path);
    return;
  }
  const int number = record("sync\t" + path + "\t" + std::to_string(is.st_ino));
  const std::string copy = environment("HOUGHSTREAM_DISK_RECORD") + "/" + std::to_string(number);
  const auto open_file = real<int(const char*, int, ...)>("open");
  const int in = open_file(("/proc/self/fd/" + std::to_string(file)).c_str(), O_RDONLY | O_CLOEXEC);
  const int out = open_file(copy.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  char bytes[65536];
  for (ssize_t size = 0; (size = read(in, bytes, sizeof bytes)) > 0;) {
    if (write(out, bytes, static_cast<std::size_t>(size)) != size) abort();
  }
  close(in);
  close(out);
}

mode_t mode_of(int flags, va_list list) {
  return (flags & O_CREAT) != 0 ? va_arg(list, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  const auto open_file = [&] { return real<int(const char*, int, ...)>("open")(path, flags, mode); };
  return open_and_record(open_file, path_of(AT_FDCWD, path), flags);
}
int openat(int folder, const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  const auto open_file = [&] { return real<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode); };
  return open_and_record(open_file, path_of(folder, path), flags);
}
int open64(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  return open(path, flags | O_LARGEFILE, mode);
}

FILE* fopen(const char* name, const char* mode) {
  return fopen_and_record("fopen", name, mode);
}
FILE* fopen64(const char* name, const char* mode) {
  return fopen_and_record("fopen64", name, mode);
}

int mkdir(const char* name, mode_t mode) {
  const int result = real<int(const char*, mode_t)>("mkdir")(name, mode);
  if (result == 0) record_file("folder", path_of(AT_FDCWD, name));
  return result;
}

int link(const char* from, const char* to) {
  const int result = real<int(const char*, const char*)>("link")(from, to);
  if (result == 0) record_names("link", path_of(AT_FDCWD, from), path_of(AT_FDCWD, to));
  return result;
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  const int result =
      real<int(int, const char*, int, const char*, int)>("linkat")(from_folder, from, to_folder, to, flags);
  if (result == 0) record_names("link", path_of(from_folder, from), path_of(to_folder, to));
  return result;
}
int symlink(const char* target, const char* name) {
  const int result = real<int(const char*, const char*)>("symlink")(target, name);
  if (result == 0) record_file("create", path_of(AT_FDCWD, name));
  return result;
}

int rename(const char* from, const char* to) {
  const int result = real<int(const char*, const char*)>("rename")(from, to);
  if (result == 0) record_names("rename", path_of(AT_FDCWD, from), path_of(AT_FDCWD, to));
  return result;
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  if (!environment("HOUGHSTREAM_DISK_NO_EXCHANGE").empty()) {
    errno = EINVAL;
    return -1;
  }
  const int result =
      real<int(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from, to_folder, to, flags);
  if (result == 0) record_names("exchange", path_of(from_folder, from), path_of(to_folder, to));
  return result;
}

int unlink(const char* name) {
  const int result = real<int(const char*)>("unlink")(name);
  if (result == 0) record_names("remove", path_of(AT_FDCWD, name), "");
  return result;
}
int unlinkat(int folder, const char* name, int flags) {
  const std::string path = path_of(folder, name);
  const int result = real<int(int, const char*, int)>("unlinkat")(folder, name, flags);
  if (result == 0) record_names("remove", path, "");
  return result;
}
int rmdir(const char* name) {
  const int result = real<int(const char*)>("rmdir")(name);
  if (result == 0) record_names("remove", path_of(AT_FDCWD, name), "");
  return result;
}
int remove(const char* name) {
  const int result = real<int(const char*)>("remove")(name);
  if (result == 0) record_names("remove", path_of(AT_FDCWD, name), "");
  return result;
}

int fsync(int file) {
  record_sync(file);
  return real<int(int)>("fsync")(file);
}
int fdatasync(int file) {
  record_sync(file);
  return real<int(int)>("fdatasync")(file);
}

}  // extern "C"
