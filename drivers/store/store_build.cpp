#include "drivers/store/store_build.hpp"

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

/// Where a store lies, symbolic links followed: the store is exchanged, not the link to it.
fs::path place_of_store(const fs::path& store) {
  std::error_code error;
  fs::path whole = fs::absolute(store, error);
  if (!error) whole = fs::weakly_canonical(whole, error);
  require(!error, "'{}': cannot be looked for: {}, expected the folder of an object store", store.string(),
          error.message());
  fs::path place = (whole / "").parent_path();
  require(!fs::is_symlink(place), "{}: a symbolic link to nothing, expected an object store, or nothing yet",
          place.string());
  return place;
}

int open_folder(const fs::path& folder) {
  return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

/// Who looks whether anybody works on a store, and says then that he does, is alone with that: two who begin together
/// would both find nobody. Waits for those before, who take a moment. Leaves no file beside the store.
class Turn {
 public:
  explicit Turn(const fs::path& folder) : file_(open_folder(folder)) {
    while (file_ >= 0 && flock(file_, LOCK_EX) != 0) {
      if (errno == EINTR) continue;
      close(file_);
      file_ = -1;
    }
    require(file_ >= 0, "{}: cannot be locked: {}, expected a folder to make a store in", folder.string(),
            std::strerror(errno));
  }
  ~Turn() { close(file_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int file_;
};

/// An open folder that nobody else has locked, or -1. The lock ends with its process, however that ends.
int try_lock(const fs::path& folder) {
  const int file = open_folder(folder);
  if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  if (file >= 0) close(file);
  return -1;
}

std::string partial_prefix(const fs::path& store) {
  return "." + store.filename().string() + ".partial-";
}

/// What earlier teachings left. Throws InputError where one of them is still at work.
void remove_leftovers(const fs::path& store) {
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(store.parent_path())) {
    if (entry.path().filename().string().rfind(partial_prefix(store), 0) == 0) left.push_back(entry.path());
  }
  for (const fs::path& folder : left) {
    const int lock = try_lock(folder);
    require(lock >= 0, "{}: another teaching works on {}, expected one at a time", folder.string(), store.string());
    std::error_code error;
    fs::remove_all(folder, error);
    close(lock);
    require(!error, "{}: left by an interrupted teaching and cannot be removed: {}", folder.string(), error.message());
  }
}

/// Where the old store waits for a moment on a file system that cannot exchange folders.
fs::path place_of_old(const fs::path& store) {
  return store.parent_path() / ("." + store.filename().string() + ".before");
}

/// After a teaching that was interrupted in that moment.
void bring_back_old(const fs::path& store) {
  std::error_code error;
  if (!fs::exists(place_of_old(store))) return;
  if (fs::exists(store)) {
    fs::remove_all(place_of_old(store), error);
  } else {
    fs::rename(place_of_old(store), store, error);
  }
  require(!error, "{}: left by an interrupted teaching and cannot be moved: {}", place_of_old(store).string(),
          error.message());
}

void require_replaceable(const fs::path& store) {
  require(may_be_replaced(store),
          "{}: holds no store.json of an object store, expected one, or nothing yet: not replaced", store.string());
}

/// Both folders change places at once (Linux 3.15); false where the file system cannot.
bool exchange(const fs::path& one, const fs::path& other) {
  return syscall(SYS_renameat2, AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace

void bring_back_store(const fs::path& store) {
  const fs::path place = place_of_store(store);
  if (fs::exists(place) || !fs::exists(place_of_old(place))) return;
  const Turn turn(place.parent_path());
  remove_leftovers(place);
  bring_back_old(place);
}

void require_place_for_store(const fs::path& store) {
  const fs::path place = place_of_store(store);
  require_replaceable(place);
  require_writable_folder(place.parent_path());
}

StoreBuild::StoreBuild(const fs::path& store) : store_(place_of_store(store)) {
  require_replaceable(store_);
  std::error_code error;
  fs::create_directories(store_.parent_path(), error);
  require(!error, "{}: cannot make this folder: {}", store_.parent_path().string(), error.message());
  const Turn turn(store_.parent_path());
  remove_leftovers(store_);
  bring_back_old(store_);
  partial_ = store_.parent_path() / (partial_prefix(store_) + std::to_string(getpid()));
  fs::create_directory(partial_, error);
  require(!error, "{}: cannot make this folder: {}", partial_.string(), error.message());
  lock_ = try_lock(partial_);
  require(lock_ >= 0, "{}: cannot be locked: {}", partial_.string(), std::strerror(errno));
}

StoreBuild::~StoreBuild() {
  std::error_code error;
  fs::remove_all(partial_, error);  // after publish(), what the store was before
  if (lock_ >= 0) close(lock_);
}

void StoreBuild::publish() {
  std::error_code error;
  if (!fs::exists(store_)) {
    fs::rename(partial_, store_, error);
    require(!error, "{}: cannot be put into its place: {}", store_.string(), error.message());
    return;
  }
  if (exchange(partial_, store_)) return;
  const fs::path old = place_of_old(store_);
  fs::rename(store_, old, error);
  require(!error, "{}: cannot be replaced: {}", store_.string(), error.message());
  fs::rename(partial_, store_, error);
  if (error) fs::rename(old, store_);
  require(!error, "{}: cannot be put into its place: {}", store_.string(), error.message());
  fs::remove_all(old, error);
}

}  // namespace houghstream::store
