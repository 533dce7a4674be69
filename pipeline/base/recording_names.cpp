#include "pipeline/base/recording_names.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// A dangling link is there too: a recording must not take its place.
bool has_name(const fs::path& file) {
  std::error_code error;
  return fs::exists(fs::symlink_status(file, error));
}

/// An open file; closed with its lock.
class OpenFile {
 public:
  explicit OpenFile(const fs::path& file)
      : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// Returns whether it is a regular, non-empty file that no program writes any more; it stays locked.
  bool is_left_over() const {
    struct stat is {};
    return descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) == 0 && fstat(descriptor_, &is) == 0 &&
           S_ISREG(is.st_mode) && is.st_size > 0;
  }

 private:
  int descriptor_;
};

}  // namespace

fs::path next_recording_name(const fs::path& file) {
  fs::path name = file;
  for (int number = 2; has_name(name); ++number)
    name = file.parent_path() / fmt::format("{}_{}{}", file.stem().string(), number, file.extension().string());
  return name;
}

bool rename_to_free_name(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // The file system does not know the flag. Between the two steps the name may be taken, which it cannot prevent.
  if (has_name(to)) {
    errno = EEXIST;
    return false;
  }
  return std::rename(from.c_str(), to.c_str()) == 0;
}

std::optional<fs::path> keep_interrupted(const fs::path& file, const std::string& ending) {
  fs::path partial = file;
  partial += ending;
  const OpenFile opened(partial);
  if (!opened.is_left_over()) return std::nullopt;
  const fs::path format = partial.extension() == ".partial" ? file.extension() : partial.extension();
  for (int number = 1;; ++number) {
    const fs::path name =
        file.parent_path() / fmt::format("{}.interrupted-{}{}", file.stem().string(), number, format.string());
    if (rename_to_free_name(partial, name)) return name;
    require(errno == EEXIST, "{}: cannot be renamed to {}: {}", partial.string(), name.string(), std::strerror(errno));
  }
}

}  // namespace houghstream
