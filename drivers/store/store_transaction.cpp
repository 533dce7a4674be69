#include "drivers/store/store_transaction.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/folder_exchange.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

/// Returns where a store lies, with symbolic links followed: the store is exchanged, not the link to it.
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

/// Locks the check for another writer of the store and the registration as one: two processes that begin together would
/// otherwise both find none. It waits for earlier holders, who hold it briefly, and leaves no file beside the store.
class StoreLock {
 public:
  explicit StoreLock(const fs::path& folder) : file_(open_folder(folder)) {
    while (file_ >= 0 && flock(file_, LOCK_EX) != 0) {
      if (errno == EINTR) continue;
      close(file_);
      file_ = -1;
    }
    require(file_ >= 0, "{}: cannot be locked: {}, expected a folder to make a store in", folder.string(),
            std::strerror(errno));
  }
  ~StoreLock() { close(file_); }
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

 private:
  int file_;
};

/// Opens a folder that nobody else has locked and locks it; returns -1 where that fails. The lock ends with its
/// process, however that ends.
int try_lock(const fs::path& folder) {
  const int file = open_folder(folder);
  if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  if (file >= 0) close(file);
  return -1;
}

std::string partial_prefix(const fs::path& store) {
  return "." + store.filename().string() + ".partial-";
}

/// Removes the remains of earlier transactions; foreign files in them go back to the store. Throws InputError where one
/// of them is still running.
void remove_leftovers(const fs::path& store) {
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(store.parent_path())) {
    if (entry.path().filename().string().rfind(partial_prefix(store), 0) == 0) left.push_back(entry.path());
  }
  for (const fs::path& folder : left) {
    const int lock = try_lock(folder);
    require(lock >= 0, "{}: another teaching works on {}, expected one at a time", folder.string(), store.string());
    try {
      remove_replaced(folder, store, is_store_entry);
    } catch (const InputError&) {
      close(lock);
      throw;
    }
    close(lock);
  }
}

void require_replaceable(const fs::path& store) {
  require(is_replaceable(store),
          "{}: holds no store.json of an object store, expected one, or nothing yet: not replaced", store.string());
  require_exchangeable(store, is_store_entry);
}

}  // namespace

void recover_store(const fs::path& store) {
  const fs::path place = place_of_store(store);
  if (fs::exists(place) || !has_replaced(place)) return;
  const StoreLock lock(place.parent_path());
  remove_leftovers(place);
  restore_replaced(place, is_store_entry);
}

void require_place_for_store(const fs::path& store) {
  const fs::path place = place_of_store(store);
  require_replaceable(place);
  require_writable_folder(place.parent_path());
}

StoreTransaction::StoreTransaction(const fs::path& store) : store_(place_of_store(store)) {
  require_replaceable(store_);
  std::error_code error;
  fs::create_directories(store_.parent_path(), error);
  require(!error, "{}: cannot make this folder: {}", store_.parent_path().string(), error.message());
  const StoreLock lock(store_.parent_path());
  remove_leftovers(store_);
  restore_replaced(store_, is_store_entry);
  partial_ = store_.parent_path() / (partial_prefix(store_) + std::to_string(getpid()));
  fs::create_directory(partial_, error);
  require(!error, "{}: cannot make this folder: {}", partial_.string(), error.message());
  lock_ = try_lock(partial_);
  require(lock_ >= 0, "{}: cannot be locked: {}", partial_.string(), std::strerror(errno));
}

StoreTransaction::~StoreTransaction() {
  std::error_code error;
  if (!is_published_) fs::remove_all(partial_, error);
  if (lock_ >= 0) close(lock_);
}

void StoreTransaction::commit() {
  exchange_folder(partial_, store_, is_store_entry);
  is_published_ = true;
}

}  // namespace houghstream::store
