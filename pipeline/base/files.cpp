#include "pipeline/base/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/recording_names.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// An output through a symbolic link goes to what the link names, and the link stays.
fs::path followed(const fs::path& file) {
  std::error_code error;
  fs::path target = fs::is_symlink(file, error) ? fs::canonical(file, error) : fs::path();
  return error || target.empty() ? file : target;
}

bool is_device(const fs::path& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file, error).type();
  return type == fs::file_type::character || type == fs::file_type::fifo || type == fs::file_type::socket ||
         type == fs::file_type::block;
}

bool is_same(int open_file, const fs::path& file) {
  struct stat a {};
  struct stat b {};
  return fstat(open_file, &a) == 0 && stat(file.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Returns whether the path is the folder or lies in it, at any depth and by whatever name; it need not exist.
bool lies_in(const fs::path& place, const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return false;
  fs::path above = fs::weakly_canonical(fs::absolute(place, error), error);
  while (!fs::equivalent(above, folder, error)) {
    if (!above.has_relative_path()) return false;
    above = above.parent_path();
  }
  return true;
}

/// Opens the file and returns it empty and locked.
int open_locked(const fs::path& partial, const fs::path& file) {
  for (;;) {
    // A link of that name belongs to somebody else: its target must not be emptied.
    const int opened = open(partial.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    require(opened >= 0 || errno != ELOOP, "{}: cannot be written: {} is a symbolic link", file.string(),
            partial.string());
    require(opened >= 0, "{}: cannot be written: {}", file.string(), std::strerror(errno));
    const bool locked = flock(opened, LOCK_EX | LOCK_NB) == 0;
    if (locked && is_same(opened, partial)) {
      if (ftruncate(opened, 0) == 0) return opened;
      const int error = errno;
      close(opened);
      fail("{}: cannot be written: {}", file.string(), std::strerror(error));
    }
    close(opened);  // its previous holder may have renamed it to its final name meanwhile
    require(locked, "{}: another program is writing it ({})", file.string(), partial.string());
  }
}

/// Returns whether the error is that of some network and FUSE file systems, and of some special files, which cannot
/// synchronise.
bool knows_no_sync(int error) {
  return error == EINVAL || error == ENOSYS || error == ENOTSUP || error == EROFS;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void require_regular_file(const fs::path& file, const char* expected) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  require(fs::exists(status), "{}: missing or unreadable, expected {}", file.string(), expected);
  require(fs::is_regular_file(status), "{}: is {}, expected {}", file.string(),
          fs::is_directory(status) ? "a folder" : "no ordinary file", expected);
}

std::string read_file(const fs::path& file, const char* expected) {
  require_regular_file(file, expected);
  std::ifstream in(file, std::ios::binary);
  require(in.good(), "{}: missing or unreadable, expected {}", file.string(), expected);
  const std::streamoff size = in.seekg(0, std::ios::end).tellg();
  std::string bytes(static_cast<std::size_t>(std::max<std::streamoff>(size, 0)), '\0');
  in.seekg(0).read(bytes.data(), size);
  require(in.gcount() == size, "{}: cannot be read to its end, expected {}", file.string(), expected);
  return bytes;
}

void require_other_file(const fs::path& output, const fs::path& input) {
  if (output.empty()) return;
  std::error_code missing;
  require(!fs::equivalent(output, input, missing), "{}: is the source itself, expected another place to write",
          output.string());
  fs::path partial = followed(output);
  partial += kPartialEnding;
  require(!fs::equivalent(partial, input, missing), "{}: is first written to {}, the source, expected another place",
          output.string(), partial.string());
  require(!lies_in(output, input), "{}: lies in {}, the source, expected another place to write", output.string(),
          input.string());
}

void require_writable(const fs::path& file) {
  std::error_code error;
  require(!fs::is_directory(file, error), "{}: is a folder, expected a file to write", file.string());
  if (is_device(file)) return;
  const fs::path folder = fs::absolute(followed(file), error).parent_path();
  require(fs::is_directory(folder, error), "{}: cannot be written: there is no folder {}", file.string(),
          folder.string());
  const bool takes_files = access(folder.c_str(), W_OK | X_OK) == 0;
  require(takes_files, "{}: cannot be written: {}", file.string(), std::strerror(errno));
}

void require_writable_folder(const fs::path& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  require(fs::is_directory(there, error), "{}: cannot be a folder to write to: {} is not a directory", folder.string(),
          there.string());
  const bool takes_files = access(there.c_str(), W_OK | X_OK) == 0;
  require(takes_files, "{}: cannot be written: {}", folder.string(), std::strerror(errno));
}

void sync_to_disk(const fs::path& path) {
  const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (opened < 0 && errno == EACCES) return;  // a folder that may be written and not read
  const bool is_synced = opened >= 0 && (fsync(opened) == 0 || knows_no_sync(errno));
  const int error = errno;
  if (opened >= 0) close(opened);
  require(is_synced, "{}: may not be on the disk: {}", path.string(), std::strerror(error));
}

AtomicFile::AtomicFile(const fs::path& file, const std::string& ending, Existing existing)
    : wanted_(followed(file)), file_(wanted_), partial_(file_), existing_(existing) {
  std::error_code error;
  require(!fs::is_directory(file_, error), "{}: is a folder, expected a file to write", file_.string());
  if (is_device(file_)) return;
  if (existing_ == Existing::kRecordingKept) file_ = next_recording_name(wanted_);
  if (existing_ != Existing::kReplaced) interrupted_ = keep_interrupted(file_, ending);
  partial_ = file_;
  partial_ += ending;
  lock_ = open_locked(partial_, file_);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : wanted_(std::move(other.wanted_)),
      file_(std::move(other.file_)),
      partial_(std::move(other.partial_)),
      existing_(other.existing_),
      interrupted_(std::move(other.interrupted_)),
      lock_(std::exchange(other.lock_, -1)) {}

AtomicFile::~AtomicFile() {
  if (lock_ < 0) return;
  if (is_same(lock_, partial_)) unlink(partial_.c_str());
  release();
}

void AtomicFile::release() {
  close(std::exchange(lock_, -1));
}

bool AtomicFile::rename_into_place() {
  if (existing_ != Existing::kRecordingKept) return std::rename(partial_.c_str(), file_.c_str()) == 0;
  while (!rename_to_free_name(partial_, file_)) {
    if (errno != EEXIST) return false;
    file_ = next_recording_name(wanted_);
  }
  return true;
}

void AtomicFile::commit() {
  if (lock_ < 0) return;
  const bool has_replaced = put_into_place();
  if (!has_replaced) sync_to_disk(file_);
  sync_to_disk(folder_of(file_));
}

/// Returns whether FILE was there before; then the new one is on the disk, but for its name.
bool AtomicFile::put_into_place() {
  struct stat before {};
  // A library may have put another file into the place; what counts is what lies there.
  const int written = open(partial_.c_str(), O_RDONLY | O_CLOEXEC);
  require(written >= 0, "{}: cannot be written: {}", file_.string(), std::strerror(errno));
  const bool replaces = stat(file_.c_str(), &before) == 0;
  bool good = true;
  if (replaces) good = fchmod(written, before.st_mode) == 0 && (fsync(written) == 0 || knows_no_sync(errno));
  good = good && rename_into_place();
  const int error = errno;
  close(written);
  require(good, "{}: cannot be written: {}", file_.string(), std::strerror(error));
  release();
  return replaces;
}

void AtomicFile::keep_partial() {
  if (lock_ >= 0) release();
}

void write_file_atomically(const fs::path& file, std::string_view bytes) {
  AtomicFile whole(file);
  const int out = open(whole.partial().c_str(), O_WRONLY | O_CLOEXEC);
  bool good = out >= 0;
  while (good && !bytes.empty()) {
    const ssize_t written = write(out, bytes.data(), bytes.size());
    good = written >= 0 || errno == EINTR;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  const int error = errno;
  good = (out < 0 || close(out) == 0) && good;
  require(good, "{}: cannot be written: {}", file.string(), std::strerror(error));
  if (whole.lock_ >= 0 && whole.put_into_place()) sync_to_disk(folder_of(whole.file_));
}

void check_json_nesting(std::string_view text, const std::string& source) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (in_string && text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      in_string = !in_string;
    } else if (!in_string) {
      depth += text[i] == '[' || text[i] == '{' ? 1 : text[i] == ']' || text[i] == '}' ? -1 : 0;
    }
    require(depth <= kDeepest, "{}: lists within lists more than {} times", source, kDeepest);
  }
}

}  // namespace houghstream
